#include "core/history/cone_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// Channels of `colours` sums and the samples, rounded up to whole passes.
constexpr int channels_of(int colours) {
  const int used = kCones * (colours + 1) + (colours == 1 ? 2 : 0);
  return (used + kMaxFilterChannels - 1) / kMaxFilterChannels * kMaxFilterChannels;
}

/// The cone that the direction of pixel (x, y) falls into, or -1.
int cone_of(const Plane& directions, const glm::vec3& normal, int x, int y) {
  const glm::vec3 direction(directions.channel(0).at(x, y), directions.channel(1).at(x, y),
                            directions.channel(2).at(x, y));
  const float above = glm::dot(direction, normal);
  return above > 0.0f && std::isfinite(above) ? ConeFrame<float>(normal).nearest(direction) : -1;
}

void mix(const ConeMix& mix, float* values) {
  float mixed[kCones] = {};
  for (int k = 0; k < kCones; ++k)
    for (int j = 0; j < kCones; ++j) mixed[k] += mix.share[k][j] * values[j];
  std::copy_n(mixed, kCones, values);
}

}  // namespace

/// One pixel's.
struct ConeHistory::Cones {
  float sum[3][kCones] = {};
  float samples[kCones] = {};
  float chroma[2] = {};  ///< R and B that belong to the sum of luminance

  static float total(const float* values) {
    float sum = 0;
    for (int k = 0; k < kCones; ++k) sum += values[k];
    return sum;
  }

  /// L_k - sum_j W_j L_j of one colour.
  float excess(int colour, int k, float prior) const {
    const float count = total(samples);
    if (!(count > 0.0f)) return 0.0f;
    const float lean = prior * total(sum[colour]) / count;
    float mean = 0, own = 0;
    for (int j = 0; j < kCones; ++j) {
      const float radiance = (sum[colour][j] + lean) / (samples[j] + prior);
      mean += cone_weight<float>(j) * radiance;
      own = j == k ? radiance : own;
    }
    return own - mean;
  }

  /// R, G, B of a unit of luminance.
  glm::vec3 hue() const {
    const float all = total(sum[0]);
    if (!(all > 0.0f)) return glm::vec3(1.0f);
    const float r = chroma[0] / all, b = chroma[1] / all;
    return {r, std::max(1.0f - 0.2126f * r - 0.0722f * b, 0.0f) / 0.7152f, b};
  }

  /// Into the cones of another normal; returns whether that differs.
  bool turn(const glm::vec3& from, const glm::vec3& to, int colours);

  void learn(const glm::vec3& sample, int colours, int k, float most) {
    const float keep = std::min(1.0f, (most - 1.0f) / std::max(samples[k], 1e-20f));
    samples[k] = keep * samples[k] + 1.0f;
    if (colours == 3) {
      for (int c = 0; c < 3; ++c) sum[c][k] = keep * sum[c][k] + sample[c];
      return;
    }
    const float before = total(sum[0]);
    const float left = before > 0.0f ? 1.0f - (1.0f - keep) * sum[0][k] / before : 0.0f;
    sum[0][k] = keep * sum[0][k] + luminance(sample.x, sample.y, sample.z);
    chroma[0] = left * chroma[0] + sample.x;
    chroma[1] = left * chroma[1] + sample.z;
  }
};

ConeHistory::ConeHistory(int width, int height, RadianceBasis basis)
    : colours_(basis == RadianceBasis::kConesColour ? 3 : 1),
      kept_(width, height, channels_of(colours_)),
      updated_(width, height, channels_of(colours_)) {}

/// What was kept at `taps`, of the block from (x0, y) on, as it was; 0 where there are none.
void ConeHistory::recall(const Taps* taps, int count, int x0, int y) {
  const std::ptrdiff_t dx = kept_.width() > 1 ? 1 : 0;
  for (int c = 0; c < kept_.count(); ++c) {
    float* __restrict out = updated_[c].row(y) + x0;
    const auto in = std::as_const(kept_)[c];
    const std::ptrdiff_t dy = in.height > 1 ? in.stride : 0;
    for (int i = 0; i < count; ++i) {
      const float* p = in.data + taps[i].offset;
      const float* w = taps[i].weight;
      out[i] = w[0] * p[0] + w[1] * p[dx] + w[2] * p[dy] + w[3] * p[dy + dx];
    }
  }
}

ConeHistory::Cones ConeHistory::load(int x, int y) const {
  Cones cones;
  int channel = 0;
  for (int c = 0; c < colours_; ++c)
    for (float& sum : cones.sum[c]) sum = updated_[channel++].at(x, y);
  for (float& samples : cones.samples) samples = updated_[channel++].at(x, y);
  if (colours_ == 1)
    for (float& chroma : cones.chroma) chroma = updated_[channel++].at(x, y);
  return cones;
}

/// Puts back cone k, or all of them (k < 0), and the chroma.
void ConeHistory::store(const Cones& cones, int k, int x, int y) {
  const int first = k < 0 ? 0 : k, last = k < 0 ? kCones - 1 : k;
  for (int i = first; i <= last; ++i) {
    for (int c = 0; c < colours_; ++c) updated_[c * kCones + i].at(x, y) = cones.sum[c][i];
    updated_[colours_ * kCones + i].at(x, y) = cones.samples[i];
  }
  if (colours_ == 1)
    for (int c = 0; c < 2; ++c) updated_[2 * kCones + c].at(x, y) = cones.chroma[c];
}

bool ConeHistory::Cones::turn(const glm::vec3& from, const glm::vec3& to, int colours) {
  const float length2 = glm::dot(from, from);
  if (!(length2 > 0.0f) || glm::dot(from, to) >= kSameConesCosine * std::sqrt(length2))
    return false;
  const ConeMix turned(ConeFrame<float>(glm::normalize(from)), ConeFrame<float>(to));
  for (int c = 0; c < colours; ++c) mix(turned, sum[c]);
  mix(turned, samples);
  return true;
}

/// Corrects one pixel's sample by the cones recalled for it, and adds it to them.
void ConeHistory::correct_pixel(const FramePair& frames, const Taps& taps, const Plane& directions,
                                const ConeRule& rule, int x, int y, Channels<float>& noisy) {
  const glm::vec3 normal = frames.now.normal_at(x, y);
  Cones cones = load(x, y);
  const Guides& previous = frames.previous;
  const bool turned =
      taps.any() && cones.turn({gather(previous.normal(0), taps), gather(previous.normal(1), taps),
                                gather(previous.normal(2), taps)},
                               normal, colours_);
  const int k = cone_of(directions, normal, x, y);
  if (k >= 0) {
    const glm::vec3 sample(noisy[0].at(x, y), noisy[1].at(x, y), noisy[2].at(x, y));
    glm::vec3 excess;
    if (colours_ == 3)
      for (int c = 0; c < 3; ++c) excess[c] = cones.excess(c, k, rule.prior_samples);
    else
      excess = cones.excess(0, k, rule.prior_samples) * cones.hue();
    for (int c = 0; c < 3; ++c) noisy[c].at(x, y) = sample[c] - excess[c];
    cones.learn(sample, colours_, k, rule.most_samples);
  }
  if (turned || k >= 0) store(cones, turned ? -1 : k, x, y);
}

void ConeHistory::correct(const FramePair& frames, const SurfaceHistory* surface,
                          const EffectHistory* effect, std::span<const ConeSamples> samples,
                          const ConeRule& rule, WindowScratch& window) {
  constexpr int kBlock = 64;  // pixels: the rows of all channels stay in the first caches
  const Guides& now = frames.now;
  for_each_row(now.view.height, [&](int y) {
    Taps taps[kBlock];
    for (int x0 = 0; x0 < now.view.width; x0 += kBlock) {
      const int count = std::min(kBlock, now.view.width - x0);
      for (int i = 0; i < count; ++i) {
        taps[i] = Taps{};
        if (surface == nullptr || !(now.depth().at(x0 + i, y) > 0.0f)) continue;
        taps[i] = surface->taps[0].at(x0 + i, y);
        if (!taps[i].any() && effect != nullptr) taps[i] = effect->taps[0].at(x0 + i, y);
      }
      recall(taps, count, x0, y);
      for (int i = 0; i < count; ++i) {
        if (!(now.depth().at(x0 + i, y) > 0.0f)) continue;
        for (const ConeSamples& sample : samples) {
          correct_pixel(frames, taps[i], *sample.directions, rule, x0 + i, y, *sample.radiance);
          taps[i] = Taps{};  // cones turn once
        }
      }
    }
  });
  spread_out(now, window);
}

/// Means over 3x3 pixels of the same surface; sums and samples alike, so that a cone counts in its
/// neighbours by its samples.
void ConeHistory::spread_out(const Guides& guides, WindowScratch& window) {
  FilterRow pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.channels = kMaxFilterChannels;
  pass.spread_in = std::as_const(window.spread)[0];
  pass.spread_out = window.spread[1];
  for (int first = 0; first < kept_.count(); first += kMaxFilterChannels) {
    for (int c = 0; c < kMaxFilterChannels; ++c) {
      pass.in[c] = std::as_const(updated_)[first + c];
      pass.out[c] = kept_[first + c];
    }
    filter_image(pass);
  }
}

}  // namespace holdfast
