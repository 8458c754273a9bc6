#include "client/measure/ssim.h"

#include <array>
#include <cmath>

#include "client/measure/convolve.h"

namespace holdfast::measure {
namespace {

constexpr int kRadius = 5;           // 11x11 window; Wang et al. 2004, sec. III.B
constexpr double kSigma = 1.5;       // pixels; same place
constexpr double kC1 = 0.01 * 0.01;  // (K1 L)^2 with L = 1
constexpr double kC2 = 0.03 * 0.03;  // (K2 L)^2

std::array<float, 2 * kRadius + 1> gaussian_taps() {
  std::array<float, 2 * kRadius + 1> taps{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) sum += std::exp(-i * i / (2 * kSigma * kSigma));
  for (int i = -kRadius; i <= kRadius; ++i)
    taps[static_cast<std::size_t>(i + kRadius)] =
        static_cast<float>(std::exp(-i * i / (2 * kSigma * kSigma)) / sum);
  return taps;
}

std::vector<float> products(const float* a, const float* b, std::size_t count) {
  std::vector<float> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = a[i] * b[i];
  return out;
}

double ssim(double mx, double my, double xx, double yy, double xy) {
  const double variance_x = xx - mx * mx, variance_y = yy - my * my, covariance = xy - mx * my;
  return (2 * mx * my + kC1) * (2 * covariance + kC2) /
         ((mx * mx + my * my + kC1) * (variance_x + variance_y + kC2));
}

}  // namespace

SsimReference::SsimReference(const Image& reference, const Mask& surface)
    : reference_(reference), surface_(surface) {
  static const auto taps = gaussian_taps();
  inverse_weight_.assign(surface_.begin(), surface_.end());
  convolve(inverse_weight_.data(), reference.width, reference.height, taps, taps, Border::kZero,
           inverse_weight_.data());
  for (std::size_t i = 0; i < surface_.size(); ++i)
    inverse_weight_[i] = surface_[i] ? 1.0f / inverse_weight_[i] : 0.0f;
  for (int c = 0; c < reference.channels; ++c) {
    const float* x = reference.channel(c);
    mean_.push_back(window_mean({x, x + reference.pixels()}));
    mean_of_square_.push_back(window_mean(products(x, x, reference.pixels())));
  }
}

std::vector<float> SsimReference::window_mean(const std::vector<float>& values) const {
  static const auto taps = gaussian_taps();
  std::vector<float> out(values.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = surface_[i] ? values[i] : 0.0f;
  convolve(out.data(), reference_.width, reference_.height, taps, taps, Border::kZero, out.data());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] *= inverse_weight_[i];
  return out;
}

std::vector<float> SsimReference::map(const Image& test) const {
  const std::size_t count = reference_.pixels();
  std::vector<double> sum(count);
  for (int c = 0; c < reference_.channels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const float *x = reference_.channel(c), *y = test.channel(c);
    const auto my = window_mean({y, y + count});
    const auto yy = window_mean(products(y, y, count));
    const auto xy = window_mean(products(x, y, count));
    const auto &mx = mean_[channel], &xx = mean_of_square_[channel];
    for (std::size_t i = 0; i < count; ++i)
      if (surface_[i])
        sum[i] +=
            ssim(static_cast<double>(mx[i]), static_cast<double>(my[i]), static_cast<double>(xx[i]),
                 static_cast<double>(yy[i]), static_cast<double>(xy[i]));
  }
  std::vector<float> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(sum[i] / reference_.channels);
  return out;
}

}  // namespace holdfast::measure
