#include "core/spatial/window.h"

#include <utility>

namespace holdfast {

WindowScratch::WindowScratch(int width, int height)
    : between(width, height, kMaxFilterChannels), spread(width, height, 3) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) spread[0].at(x, y) = 1.0f;
}

ChannelView<const float> window_means(const Guides& guides, const Channels<float>& in, int count,
                                      int second_step, WindowScratch& scratch, Channels<float>& out,
                                      int first_out, const ActivityMap* activity,
                                      const Channels<float>* footprint) {
  FilterRow pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.channels = count;
  pass.activity = activity;
  if (footprint != nullptr)
    for (int c = 0; c < 3; ++c) pass.footprint[c] = (*footprint)[c];
  pass.spread = Spread::kVariance;
  for (int c = 0; c < count; ++c) {
    pass.in[c] = in[c];
    pass.out[c] = scratch.between[c];
  }
  pass.spread_in = std::as_const(scratch.spread)[0];
  pass.spread_out = scratch.spread[1];
  filter_image(pass);

  pass.step = second_step;
  for (int c = 0; c < count; ++c) {
    pass.in[c] = std::as_const(scratch.between)[c];
    pass.out[c] = out[first_out + c];
  }
  pass.spread_in = std::as_const(scratch.spread)[1];
  pass.spread_out = scratch.spread[2];
  filter_image(pass);
  return std::as_const(scratch.spread)[2];
}

}  // namespace holdfast
