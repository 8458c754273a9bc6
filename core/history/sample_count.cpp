#include "core/history/sample_count.h"

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr int kLanes = 4;  // sums that do not wait for each other

}  // namespace

SampleCount::SampleCount(int height) : rows_(static_cast<std::size_t>(height)) {}

void SampleCount::measure(const Guides& guides, const ComponentHistory& history) {
  for_each_row(guides.view.height, [&](int y) {
    const float *depth = guides.depth().row(y), *samples = history.samples().row(y);
    Row lanes[kLanes];
    const auto add = [&](int x, Row& to) {
      const bool surface = depth[x] > 0.0f;
      const double there = surface ? static_cast<double>(samples[x]) : 0.0;
      to.samples += there;
      to.pixels += surface ? 1.0 : 0.0;
      to.known += there > 0.0 ? 1.0 : 0.0;
    };
    int x = 0;
    for (; x + kLanes <= guides.view.width; x += kLanes)
      for (int lane = 0; lane < kLanes; ++lane) add(x + lane, lanes[lane]);
    for (; x < guides.view.width; ++x) add(x, lanes[0]);
    for (int lane = 1; lane < kLanes; ++lane) lanes[0] += lanes[lane];
    rows_[static_cast<std::size_t>(y)] = lanes[0];
  });
  total_ = {};
  for (const Row& row : rows_) total_ += row;
}

}  // namespace holdfast
