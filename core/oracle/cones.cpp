#include "core/oracle/cones.h"

#include <algorithm>
#include <cmath>

#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

constexpr double kSameNormal = double{kSameConesCosine};
constexpr double kNoLight = 1e-30;  // luminance that has no hue

double total(const double (&of)[kCones]) {
  double sum = 0;
  for (const double v : of) sum += v;
  return sum;
}

/// The cone of a sample's direction, or -1 if there is none above the surface.
int cone_of(const Surfaces& now, const Image& directions, int x, int y) {
  const glm::dvec3 direction(directions.at(x, y, 0), directions.at(x, y, 1),
                             directions.at(x, y, 2));
  if (!now.any(x, y)) return -1;
  const double above = glm::dot(direction, now.normal_at(x, y));
  if (!(above > 0) || !std::isfinite(above)) return -1;
  return ConeFrame<double>(now.normal_at(x, y)).nearest(direction);
}

/// R, G, B of a unit of luminance; white where there is no light.
glm::dvec3 hue_of(double luminance, const double (&chroma)[2]) {
  if (!(luminance > kNoLight)) return glm::dvec3(1);
  const double r = chroma[0] / luminance, b = chroma[1] / luminance;
  return {r, std::max(1 - 0.2126 * r - 0.0722 * b, 0.0) / 0.7152, b};
}

}  // namespace

void Cones::correct(const FrameView& frame, const Past* effect, std::span<DirectedSamples> samples,
                    const ConeRule& rule) {
  const Surfaces& now = frame.now;
  Image updated(now.width, now.height, channels());
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    Taps taps;
    if (frame.surface != nullptr) taps = frame.surface->at(x, y);
    if (frame.surface != nullptr && !taps.any() && effect != nullptr) taps = effect->at(x, y);
    Pixel pixel = recall(frame, taps, x, y);
    for (DirectedSamples& each : samples) take(pixel, now, each, rule, x, y);
    int channel = 0;
    for (int c = 0; c < colours_; ++c)
      for (const double v : pixel.sum[c]) updated.at(x, y, channel++) = v;
    for (const double v : pixel.samples) updated.at(x, y, channel++) = v;
    for (const double v : pixel.chroma)
      if (channel < channels()) updated.at(x, y, channel++) = v;
  });
  const Image ones(now.width, now.height, 1, 1.0);
  kept_ = filter_pass(now, updated, ones, box_pass(1)).values;
}

void Cones::take(Pixel& pixel, const Surfaces& now, DirectedSamples& samples, const ConeRule& rule,
                 int x, int y) const {
  const int cone = cone_of(now, samples.direction, x, y);
  if (cone < 0) return;
  Image& noisy = samples.radiance;
  const glm::dvec3 given(noisy.at(x, y, 0), noisy.at(x, y, 1), noisy.at(x, y, 2));
  const glm::dvec3 off = excess(pixel, cone, rule);
  learn(pixel, cone, given, rule);
  for (int c = 0; c < 3; ++c) noisy.at(x, y, c) -= off[c];
}

Cones::Pixel Cones::recall(const FrameView& frame, const Taps& taps, int x, int y) const {
  Pixel pixel;
  if (!taps.any()) return pixel;
  int channel = 0;
  for (int c = 0; c < colours_; ++c)
    for (double& v : pixel.sum[c]) v = taps.read(kept_, channel++);
  for (double& v : pixel.samples) v = taps.read(kept_, channel++);
  for (double& v : pixel.chroma)
    if (channel < channels()) v = taps.read(kept_, channel++);
  const Image& normal = frame.previous.normal;
  const glm::dvec3 before(taps.read(normal, 0), taps.read(normal, 1), taps.read(normal, 2));
  const glm::dvec3 now = frame.now.normal_at(x, y);
  if (glm::dot(before, now) < kSameNormal * glm::length(before))
    turn(pixel, glm::normalize(before), now);
  return pixel;
}

/// Each cone goes to those that it overlaps, in proportion to the solid angle shared.
void Cones::turn(Pixel& pixel, const glm::dvec3& from, const glm::dvec3& to) const {
  const ConeFrame<double> old_frame(from), new_frame(to);
  Pixel turned;
  for (int j = 0; j < kCones; ++j) {
    double share[kCones];
    for (int k = 0; k < kCones; ++k) {
      const double cosine = glm::dot(old_frame.axis(j), new_frame.axis(k));
      share[k] = cone_overlap(std::acos(std::clamp(cosine, -1.0, 1.0)), kConeHalfAngle);
    }
    const double all = total(share);
    for (int k = 0; k < kCones && all > 0; ++k) {
      for (int c = 0; c < colours_; ++c) turned.sum[c][k] += share[k] / all * pixel.sum[c][j];
      turned.samples[k] += share[k] / all * pixel.samples[j];
    }
  }
  std::copy(std::begin(pixel.chroma), std::end(pixel.chroma), turned.chroma);
  pixel = turned;
}

/// L_k - sum_j W_j L_j; 0 where nothing is known.
glm::dvec3 Cones::excess(const Pixel& pixel, int cone, const ConeRule& rule) const {
  const double known = total(pixel.samples), prior = double{rule.prior_samples};
  if (!(known > 0)) return glm::dvec3(0);
  glm::dvec3 out(0);
  for (int c = 0; c < colours_; ++c) {
    const double mean_of_all = total(pixel.sum[c]) / known;
    double own = 0, mean = 0;
    for (int k = 0; k < kCones; ++k) {
      const double radiance = (pixel.sum[c][k] + prior * mean_of_all) / (pixel.samples[k] + prior);
      mean += cone_weight<double>(k) * radiance;
      if (k == cone) own = radiance;
    }
    out[c] = own - mean;
  }
  return colours_ == 3 ? out : out.x * hue_of(total(pixel.sum[0]), pixel.chroma);
}

void Cones::learn(Pixel& pixel, int cone, const glm::dvec3& radiance, const ConeRule& rule) const {
  double& samples = pixel.samples[cone];
  const double keep = samples > 0 ? std::min(1.0, (double{rule.most_samples} - 1) / samples) : 1.0;
  samples = keep * samples + 1;
  if (colours_ == 3) {
    for (int c = 0; c < 3; ++c) pixel.sum[c][cone] = keep * pixel.sum[c][cone] + radiance[c];
    return;
  }
  // The chroma is that of all cones: it fades by what this one loses of their sum.
  const double all = total(pixel.sum[0]), lost = (1 - keep) * pixel.sum[0][cone];
  const double left = all > kNoLight ? 1 - lost / all : 0;
  pixel.chroma[0] = left * pixel.chroma[0] + radiance.r;
  pixel.chroma[1] = left * pixel.chroma[1] + radiance.b;
  pixel.sum[0][cone] =
      keep * pixel.sum[0][cone] + 0.2126 * radiance.r + 0.7152 * radiance.g + 0.0722 * radiance.b;
}

}  // namespace holdfast::oracle
