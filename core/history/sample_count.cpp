#include "core/history/sample_count.h"

#include "core/kernels/parallel.h"

namespace holdfast {

SampleCount::SampleCount(int height) : rows_(static_cast<std::size_t>(height)) {}

void SampleCount::measure(const Guides& guides, const ComponentHistory& history) {
  for_each_row(guides.view.height, [&](int y) {
    Row row;
    for (int x = 0; x < guides.view.width; ++x) {
      if (!(guides.depth().at(x, y) > 0.0f)) continue;
      const float samples = history.samples().at(x, y);
      row.samples += static_cast<double>(samples);
      row.pixels += 1;
      row.known += samples > 0.0f ? 1 : 0;
    }
    rows_[static_cast<std::size_t>(y)] = row;
  });
  samples_ = pixels_ = known_ = 0;
  for (const Row& row : rows_) {
    samples_ += row.samples;
    pixels_ += row.pixels;
    known_ += row.known;
  }
}

}  // namespace holdfast
