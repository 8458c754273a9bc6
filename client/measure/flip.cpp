#include "client/measure/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/measure/convolve.h"
#include "client/measure/flip_color.h"
#include "client/measure/flip_exposure.h"
#include "core/kernels/parallel.h"

namespace holdfast::measure {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * kPi / 180;  // distance m * px / width m
constexpr double kFeatureWidth = 0.082;                            // w, degrees; FLIP sec. 4.2.1
constexpr float kFeaturePower = 0.5f;                              // q_f
constexpr float kLargest = 65536.0f;

/// A Gaussian term of a contrast sensitivity function: a sqrt(pi/b) exp(-pi^2 d^2 / b), d in
/// degrees.
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm kAchromatic{1.0, 0.0047};  // FLIP table 1
constexpr SensitivityTerm kRedGreen{1.0, 0.0053};
constexpr SensitivityTerm kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

using Taps = std::vector<float>;

/// Half length of the sensitivity filters: three deviations of the widest, 0.04.
int sensitivity_radius() {
  return static_cast<int>(
      std::ceil(3 * std::sqrt(kBlueYellow[0].b / (2 * kPi * kPi)) * kPixelsPerDegree));
}

double sensitivity(SensitivityTerm term, int x) {
  const double degrees = x / kPixelsPerDegree;
  return std::exp(-kPi * kPi * degrees * degrees / term.b);
}

/// Taps of a term with sum 1, and the sum of the term over the whole square before that.
struct TermTaps {
  Taps taps;
  double weight;
};
TermTaps term_taps(SensitivityTerm term) {
  const int radius = sensitivity_radius();
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += sensitivity(term, x);
  Taps taps;
  for (int x = -radius; x <= radius; ++x)
    taps.push_back(static_cast<float>(sensitivity(term, x) / sum));
  return {taps, term.a * std::sqrt(kPi / term.b) * sum * sum};
}

struct FeatureTaps {
  Taps smooth, edge, point;
};
/// The one-dimensional parts of the detectors (sec. 4.2.1): Gaussian, first and second derivative,
/// with positive weights of sum 1 and negative weights of sum -1.
FeatureTaps make_feature_taps() {
  const double deviation = 0.5 * kFeatureWidth * kPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  std::vector<double> smooth, edge, point;
  for (int x = -radius; x <= radius; ++x) {
    const double gauss = std::exp(-x * x / (2 * deviation * deviation));
    smooth.push_back(gauss);
    edge.push_back(-x * gauss);
    point.push_back((x * x / (deviation * deviation) - 1) * gauss);
  }
  const auto normalised = [](const std::vector<double>& taps) {
    double positive = 0, negative = 0;
    for (const double tap : taps) (tap > 0 ? positive : negative) += std::abs(tap);
    Taps out;
    for (const double tap : taps)
      out.push_back(static_cast<float>(tap > 0 ? tap / positive : tap < 0 ? tap / negative : 0));
    return out;
  };
  return {normalised(smooth), normalised(edge), normalised(point)};
}

template <class Pixel>
void for_pixels(std::size_t count, Pixel pixel) {
  for_each_index(std::size_t{0}, count, std::size_t{8192}, pixel);
}

/// Strength of a feature: length of the vector of its detector along x and along y.
std::vector<float> feature(const std::vector<float>& grey, int width, int height,
                           const Taps& detector, const Taps& smooth) {
  std::vector<float> along_x(grey.size()), along_y(grey.size());
  convolve(grey.data(), width, height, detector, smooth, Border::kReplicate, along_x.data());
  convolve(grey.data(), width, height, smooth, detector, Border::kReplicate, along_y.data());
  for_pixels(grey.size(), [&](std::size_t i) {
    along_x[i] = std::sqrt(along_x[i] * along_x[i] + along_y[i] * along_y[i]);
  });
  return along_x;
}

void filter(float* channel, int width, int height, const Taps& taps) {
  convolve(channel, width, height, taps, taps, Border::kReplicate, channel);
}

/// Blue-yellow sensitivity is the sum of two Gaussians, so it is two separable filters.
void filter_blue_yellow(float* channel, int width, int height) {
  static const TermTaps wide = term_taps(kBlueYellow[0]), narrow = term_taps(kBlueYellow[1]);
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> other(count);
  convolve(channel, width, height, narrow.taps, narrow.taps, Border::kReplicate, other.data());
  filter(channel, width, height, wide.taps);
  const auto share = static_cast<float>(wide.weight / (wide.weight + narrow.weight));
  for (std::size_t i = 0; i < count; ++i) channel[i] = share * channel[i] + (1 - share) * other[i];
}

/// Filters YCxCz by what the eye resolves, then to Hunt-adjusted L*a*b*, in place.
void to_percept(Image& image) {
  static const TermTaps achromatic = term_taps(kAchromatic), red_green = term_taps(kRedGreen);
  filter(image.channel(0), image.width, image.height, achromatic.taps);
  filter(image.channel(1), image.width, image.height, red_green.taps);
  filter_blue_yellow(image.channel(2), image.width, image.height);
  float *x = image.channel(0), *y = image.channel(1), *z = image.channel(2);
  for_pixels(image.pixels(), [&](std::size_t i) {
    const Color rgb = linear_rgb_from_ycxcz({x[i], y[i], z[i]});
    const Color lab =
        hunt_lab_from_linear_rgb({std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f),
                                  std::clamp(rgb.z, 0.0f, 1.0f)});
    x[i] = lab.x, y[i] = lab.y, z[i] = lab.z;
  });
}

/// The final error: the colour error, raised to a power that features lower.
float combine(float color_error, float edge_difference, float point_difference) {
  const float difference = std::max(std::abs(edge_difference), std::abs(point_difference));
  const float feature_error = std::pow(difference / std::numbers::sqrt2_v<float>, kFeaturePower);
  return std::pow(color_error, 1.0f - feature_error);
}

}  // namespace

FlipReference::FlipReference(const Image& reference, const Mask& surface) : surface_(surface) {
  exposures_ =
      reference.channels == 1 ? std::vector<float>{0.0f} : flip_exposures(reference, surface);
  for (const float exposure : exposures_) references_.push_back(percept(reference, exposure));
}

FlipReference::Percept FlipReference::percept(const Image& image, float exposure) const {
  static const FeatureTaps taps = make_feature_taps();
  static const TermTaps achromatic = term_taps(kAchromatic);
  const int width = image.width, height = image.height;
  const float scale = std::exp2(exposure);
  Percept out{Image(width, height, image.channels), {}, {}};
  std::vector<float> grey(image.pixels());
  if (image.channels == 1) {
    for_pixels(grey.size(), [&](std::size_t i) {
      grey[i] = surface_[i] ? std::clamp(image.values[i], 0.0f, 1.0f) : 0.0f;
    });
    out.color.values = grey;
    filter(out.color.channel(0), width, height, achromatic.taps);
    for_pixels(grey.size(), [&](std::size_t i) {
      out.color.values[i] = lightness_of_grey(std::clamp(out.color.values[i], 0.0f, 1.0f));
    });
  } else {
    const auto displayed = [&](int c, std::size_t i) {
      const float value = std::clamp(image.channel(c)[i], 0.0f, kLargest);
      return surface_[i] ? aces_tonemap(scale * value) : 0.0f;
    };
    for_pixels(grey.size(), [&](std::size_t i) {
      const Color color =
          ycxcz_from_linear_rgb({displayed(0, i), displayed(1, i), displayed(2, i)});
      grey[i] = (color.x + 16) / 116;
      out.color.channel(0)[i] = color.x;
      out.color.channel(1)[i] = color.y;
      out.color.channel(2)[i] = color.z;
    });
    to_percept(out.color);
  }
  out.edges = feature(grey, width, height, taps.edge, taps.smooth);
  out.points = feature(grey, width, height, taps.point, taps.smooth);
  return out;
}

std::vector<float> FlipReference::map(const Image& test) const {
  std::vector<float> worst(test.pixels());
  for (std::size_t e = 0; e < exposures_.size(); ++e) {
    const Percept& reference = references_[e];
    const Percept tested = percept(test, exposures_[e]);
    const auto color = [&](const Image& image, std::size_t i) {
      return image.channels == 1
                 ? Color{image.values[i], 0, 0}
                 : Color{image.channel(0)[i], image.channel(1)[i], image.channel(2)[i]};
    };
    for_pixels(worst.size(), [&](std::size_t i) {
      const float distance = hyab_distance(color(reference.color, i), color(tested.color, i));
      const float error =
          combine(redistributed_color_error(distance), reference.edges[i] - tested.edges[i],
                  reference.points[i] - tested.points[i]);
      worst[i] = std::max(worst[i], error);
    });
  }
  return worst;
}

}  // namespace holdfast::measure
