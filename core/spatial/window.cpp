#include "core/spatial/window.h"

#include <algorithm>
#include <utility>

namespace holdfast {

WindowScratch::WindowScratch(int width, int height, Memory memory)
    : between(width, height, kMostChannels, memory),
      spread(width, height, 2, memory),
      ones(width, 1, 1),
      weights(width, height, memory) {
  std::fill_n(ones[0].data, width, 1.0f);
}

namespace {

FilterPass first_pass(const Guides& guides, const Channels<float>& in, int count,
                      const ActivityMap* activity, WindowScratch& scratch) {
  FilterPass pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.channels = count;
  pass.kept = &scratch.weights;
  pass.activity = activity;
  for (int c = 0; c < count; ++c) {
    pass.in[c] = in[c];
    pass.out[c] = scratch.between[c];
  }
  return pass;
}

FilterPass second_pass(const FilterPass& first, int step, const WindowScratch& scratch,
                       Channels<float>& out, int first_out) {
  FilterPass pass = first;
  pass.step = step;
  for (int c = 0; c < pass.channels; ++c) {
    pass.in[c] = scratch.between[c];
    pass.out[c] = out[first_out + c];
  }
  return pass;
}

}  // namespace

void window_means(const Guides& guides, const Channels<float>& in, int count, int second_step,
                  WindowScratch& scratch, Channels<float>& out, const ActivityMap* activity) {
  FilterPass pass = first_pass(guides, in, count, activity, scratch);
  pass.spread = Spread::kNone;
  filter_image(pass);
  filter_image(second_pass(pass, second_step, scratch, out, 0));
}

ChannelView<const float> counted_window_means(const Guides& guides, const Channels<float>& in,
                                              int count, int second_step, WindowScratch& scratch,
                                              Channels<float>& out, int first_out,
                                              const ActivityMap* activity,
                                              const Channels<float>* footprint, float precision) {
  FilterPass pass = first_pass(guides, in, count, activity, scratch);
  if (footprint != nullptr)
    for (int c = 0; c < 3; ++c) pass.footprint[c] = (*footprint)[c];
  pass.footprint_precision = precision;
  pass.spread = Spread::kVariance;
  pass.spread_in = scratch.all_ones();
  pass.spread_out = scratch.spread[0];
  filter_image(pass);
  pass = second_pass(pass, second_step, scratch, out, first_out);
  pass.spread_in = std::as_const(scratch.spread)[0];
  pass.spread_out = scratch.spread[1];
  filter_image(pass);
  return std::as_const(scratch.spread)[1];
}

}  // namespace holdfast
