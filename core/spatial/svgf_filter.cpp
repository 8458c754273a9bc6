#include "core/spatial/svgf_filter.h"

#include <algorithm>
#include <utility>

#include "core/kernels/parallel.h"
#include "core/spatial/filter_rows.h"

namespace holdfast {
namespace {

constexpr float kLuminanceSigma = 4.0f;  // SVGF sec. 4.4

}  // namespace

void svgf_filter(const Guides& guides, const Signal& signal, ChannelView<const float> moment_1,
                 ChannelView<const float> moment_2, int levels, FilterScratch& s,
                 Channels<float>& feedback, Plane& out) {
  const int width = guides.view.width, height = guides.view.height;
  for_each_row(height, [&](int y) {
    moment_variance_row({moment_1.row(y), moment_2.row(y), signal.samples.row(y),
                         signal.sample_variance.row(y), width, s.spread[0].row(y)});
  });
  for (int level = 0; level < levels; ++level) {
    const Channels<float>& from = level == 0 ? *signal.values : (level % 2 == 1 ? s.even : s.odd);
    Channels<float>& to = level % 2 == 0 ? s.even : s.odd;
    const auto variance = std::as_const(s.spread)[level % 2];
    const int last = signal.channels - 1;
    for_each_row(height, [&](int y) {
      luminance_row({{from[0].row(y), from[last / 2].row(y), from[last].row(y)},
                     signal.channels,
                     width,
                     s.guide[0].row(y),
                     nullptr});
      smooth_tolerance_row({{variance.row(std::max(y - 1, 0)), variance.row(y),
                             variance.row(std::min(y + 1, height - 1))},
                            std::as_const(s.guide)[0].row(y),
                            kLuminanceSigma,
                            width,
                            s.guide[1].row(y)});
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
      pass.in[c] = from[c];
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
