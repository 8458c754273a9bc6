#include "client/measure/flip_exposure.h"

#include <algorithm>
#include <cmath>

namespace holdfast::measure {
namespace {

// Narkowicz' fit of ACES with its pre-exposure of 0.6 folded in: (a x^2 + b x) / (c x^2 + d x + e).
constexpr double kA = 0.6 * 0.6 * 2.51, kB = 0.6 * 0.03;
constexpr double kC = 0.6 * 0.6 * 2.43, kD = 0.6 * 0.59, kE = 0.14;
constexpr double kTarget = 0.85;  // display value that bounds the exposures; sec. 4
constexpr float kLargest = 65536.0f;

/// The x > 0 that the curve maps to kTarget.
double value_at_target() {
  const double a = kA - kTarget * kC, b = kB - kTarget * kD, c = -kTarget * kE;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

/// The element at half of the sorted order (the upper one of two).
float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> luminances(const Image& rgb, const Mask& surface) {
  std::vector<float> out;
  for (std::size_t i = 0; i < surface.size(); ++i)
    if (surface[i])
      out.push_back(0.2126f * std::clamp(rgb.channel(0)[i], 0.0f, kLargest) +
                    0.7152f * std::clamp(rgb.channel(1)[i], 0.0f, kLargest) +
                    0.0722f * std::clamp(rgb.channel(2)[i], 0.0f, kLargest));
  return out;
}

}  // namespace

std::vector<float> flip_exposures(const Image& reference_rgb, const Mask& surface) {
  std::vector<float> values = luminances(reference_rgb, surface);
  const auto brightest = std::max_element(values.begin(), values.end());
  if (brightest == values.end() || !(*brightest > 0)) return {0.0f};
  const double start = std::log2(value_at_target() / static_cast<double>(*brightest));
  float middle = median(values);
  if (!(middle > 0)) {
    std::erase_if(values, [](float value) { return !(value > 0); });
    middle = median(values);
  }
  const double stop = std::log2(value_at_target() / static_cast<double>(middle));
  const int count = std::clamp(static_cast<int>(std::ceil(stop - start)), 2, kMostFlipExposures);
  std::vector<float> exposures;
  for (int i = 0; i < count; ++i)
    exposures.push_back(static_cast<float>(start + i * (stop - start) / (count - 1)));
  return exposures;
}

float aces_tonemap(float value) {
  constexpr auto a = static_cast<float>(kA), b = static_cast<float>(kB);
  constexpr auto c = static_cast<float>(kC), d = static_cast<float>(kD);
  constexpr auto e = static_cast<float>(kE);
  const float x = std::clamp(value, 0.0f, 1e18f);
  return std::clamp((a * x + b) * x / ((c * x + d) * x + e), 0.0f, 1.0f);
}

}  // namespace holdfast::measure
