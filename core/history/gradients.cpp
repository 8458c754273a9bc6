#include "core/history/gradients.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/kernels/parallel.h"
#include "core/spatial/guided_filter.h"

namespace holdfast {
namespace {

constexpr PlaneId kAnyGradient{PlaneKind::kGradient, {}};

// Channels of samples.
constexpr int kDelta = 0;
constexpr int kLargest = 1;
constexpr int kValid = 2;
constexpr int kChannels = 3;

// Share of valid samples nearby below which lambda fades: what is left is the faint weight of
// samples of other surfaces, which rounding may take for nothing.
constexpr float kLeastValid = 1e-3f;

/// The guides of each stratum's middle pixel, as a camera of a third of the resolution sees them.
void fill_guides(const Guides& now, Guides& strata) {
  const auto scale = static_cast<float>(kStratum);
  strata.view = now.view;
  strata.view.width = strata.depth_normal.width();
  strata.view.height = strata.depth_normal.height();
  strata.view.pixel_angle *= kStratum;
  strata.rays = now.rays;
  strata.rays.lateral_x *= scale;
  strata.rays.lateral_y *= scale;
  for_each_row(strata.view.height, [&](int y) {
    const int middle_y = std::min(kStratum * y + kStratum / 2, now.view.height - 1);
    for (int x = 0; x < strata.view.width; ++x) {
      const int middle_x = std::min(kStratum * x + kStratum / 2, now.view.width - 1);
      for (int c = 0; c < strata.depth_normal.count(); ++c)
        strata.depth_normal[c].at(x, y) = now.depth_normal[c].at(middle_x, middle_y);
    }
  });
}

}  // namespace

GradientScratch::GradientScratch(int frame_width, int frame_height, Memory memory) {
  const auto [width, height] = plane_size(kAnyGradient, frame_width, frame_height);
  guides = Guides(width, height, memory);
  samples = Channels<float>(width, height, kChannels, memory);
  filtered = Channels<float>(width, height, kChannels, memory);
  antilag = Channels<float>(width, height, 1, memory);
}

std::uint64_t load_gradients(const Plane& plane, float largest, GradientScratch& scratch) {
  std::atomic<std::uint64_t> repaired{0};
  for_each_row(plane.height(), [&](int y) {
    std::uint64_t in_row = 0;
    for (int x = 0; x < plane.width(); ++x) {
      const float given[2] = {plane.channel(0).at(x, y), plane.channel(1).at(x, y)};
      float used[2];
      bool is_sample = true;
      for (int c = 0; c < 2; ++c) {
        is_sample = is_sample && given[c] >= 0.0f && std::isfinite(given[c]);
        used[c] = std::min(given[c], largest);
        in_row += given[c] >= 0.0f && given[c] <= largest ? 0 : 1;
      }
      scratch.samples[kDelta].at(x, y) = is_sample ? used[0] - used[1] : 0.0f;
      const float larger = is_sample ? std::max(used[0], used[1]) : 0.0f;
      scratch.samples[kLargest].at(x, y) = larger;
      scratch.samples[kValid].at(x, y) = larger > 0.0f ? 1.0f : 0.0f;
    }
    if (in_row > 0) repaired += in_row;
  });
  return repaired;
}

ChannelView<const float> antilag_of_gradients(const Guides& now, int levels, GradientScratch& s) {
  fill_guides(now, s.guides);
  FilterPass pass;
  pass.guides = &s.guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.channels = kChannels;
  pass.spread = Spread::kNone;
  for (int level = 0; level < levels; ++level) {
    pass.step = 1 << level;
    for (int c = 0; c < kChannels; ++c) {
      pass.in[c] = std::as_const(level % 2 == 0 ? s.samples : s.filtered)[c];
      pass.out[c] = (level % 2 == 0 ? s.filtered : s.samples)[c];
    }
    filter_image(pass);
  }
  const Channels<float>& last = levels % 2 == 0 ? s.samples : s.filtered;
  for_each_row(s.antilag.height(), [&](int y) {
    for (int x = 0; x < s.antilag.width(); ++x) {
      const float delta = std::abs(last[kDelta].at(x, y)), scale = last[kLargest].at(x, y);
      const float known = std::min(last[kValid].at(x, y) / kLeastValid, 1.0f);
      s.antilag[0].at(x, y) = scale > 0.0f ? known * std::min(delta / scale, 1.0f) : 0.0f;
    }
  });
  return std::as_const(s.antilag)[0];
}

}  // namespace holdfast
