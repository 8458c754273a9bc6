#include "core/spatial/svgf_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr float kLuminanceSigma = 4.0f;  // SVGF sec. 4.4
constexpr float kYoungFrames = 4.0f;     // SVGF sec. 4.2

/// 3x3 Gaussian of the variance at (x, y), borders repeated (SVGF sec. 4.4).
float smooth_variance(ChannelView<const float> variance, int x, int y) {
  static constexpr float kGauss[2] = {0.5f, 0.25f};
  float sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      sum += kGauss[std::abs(i)] * kGauss[std::abs(j)] *
             variance.at(std::clamp(x + i, 0, variance.width - 1),
                         std::clamp(y + j, 0, variance.height - 1));
  return sum;
}

}  // namespace

void svgf_filter(const Guides& guides, const Signal& signal, ChannelView<const float> moment_1,
                 ChannelView<const float> moment_2, int levels, FilterScratch& s,
                 Channels<float>& feedback, Plane& out) {
  const int width = guides.view.width, height = guides.view.height;
  for_each_row(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const float frames = signal.samples.at(x, y), mean = moment_1.at(x, y);
      float variance = std::max(moment_2.at(x, y) - mean * mean, 0.0f);
      // Counts of frames are integers but for rounding, which must not decide.
      if (frames < kYoungFrames - 0.5f)
        variance = std::max(variance, signal.sample_variance.at(x, y)) * kYoungFrames / frames;
      s.spread[0].at(x, y) = variance;
    }
  });
  for (int level = 0; level < levels; ++level) {
    const Signal from{
        level == 0 ? signal.values : (level % 2 == 1 ? &s.even : &s.odd), signal.channels, {}, {}};
    Channels<float>& to = level % 2 == 0 ? s.even : s.odd;
    const auto variance = std::as_const(s.spread)[level % 2];
    for_each_row(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        const float l = from.luminance_at(x, y);
        s.guide[0].at(x, y) = l;
        s.guide[1].at(x, y) = 1.0f / (kLuminanceSigma * std::sqrt(smooth_variance(variance, x, y)) +
                                      1e-4f * l + 1e-20f);
      }
    });
    FilterRow pass;
    pass.guides = &guides;
    pass.channels = signal.channels;
    pass.step = 1 << level;
    pass.spread = Spread::kVariance;
    pass.spread_in = variance;
    pass.spread_out = s.spread[1 - level % 2];
    pass.luminance = std::as_const(s.guide)[0];
    pass.inverse_luminance_sigma = std::as_const(s.guide)[1];
    for (int c = 0; c < signal.channels; ++c) {
      pass.in[c] = (*from.values)[c];
      pass.out[c] = level + 1 == levels ? out.channel(c) : to[c];
    }
    filter_image(pass);
    if (level == 0)
      for_each_row(height, [&](int y) {
        for (int c = 0; c < signal.channels; ++c)
          std::copy_n(pass.out[c].row(y), width, feedback[c].row(y));
      });
  }
}

}  // namespace holdfast
