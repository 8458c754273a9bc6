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
  const bool colour = signal.channels == 3;
  const Channels<float>& first = *signal.values;
  for_each_row(height, [&](int y) {
    moment_variance_row({moment_1.row(y), moment_2.row(y), signal.samples.row(y),
                         signal.sample_variance.row(y), width, s.spread[0].row(y)});
    if (colour)
      luminance_row({{first[0].row(y), first[1].row(y), first[2].row(y)},
                     3,
                     width,
                     s.guide[0].row(y),
                     nullptr});
  });
  FilterPass pass;
  pass.guides = &guides;
  pass.channels = signal.channels;
  pass.spread = Spread::kVariance;
  pass.inverse_luminance_sigma = std::as_const(s.guide)[1];
  const Channels<float>* from = signal.values;
  for (int level = 0; level < levels; ++level) {
    const bool last = level + 1 == levels;
    const int now = 2 * (level % 2), next = 2 - now;  // channels of the guide: luminance
    const auto variance = std::as_const(s.spread)[level % 2];
    pass.luminance = colour ? std::as_const(s.guide)[now] : (*from)[0];
    for_each_row(height, [&](int y) {
      smooth_tolerance_row({{variance.row(std::max(y - 1, 0)), variance.row(y),
                             variance.row(std::min(y + 1, height - 1))},
                            pass.luminance.row(y),
                            kLuminanceSigma,
                            width,
                            s.guide[1].row(y)});
    });
    Channels<float>& to = level == 0 ? feedback : level % 2 == 1 ? s.even : s.odd;
    pass.step = 1 << level;
    pass.spread_in = variance;
    pass.spread_out = s.spread[1 - level % 2];
    pass.luminance_out = colour && !last ? s.guide[next] : ChannelView<float>();
    for (int c = 0; c < signal.channels; ++c) {
      pass.in[c] = (*from)[c];
      pass.out[c] = last && level > 0 ? out.channel(c) : to[c];
    }
    filter_image(pass);
    from = &to;
  }
  if (levels > 1) return;
  for_each_row(height, [&](int y) {
    for (int c = 0; c < signal.channels; ++c)
      std::copy_n(std::as_const(feedback)[c].row(y), width, out.channel(c).row(y));
  });
}

}  // namespace holdfast
