#include "core/spatial/activity.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {
constexpr int tiles(int pixels, int size) { return (pixels + size - 1) / size; }
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}  // namespace

ActivityMap::ActivityMap(int width, int height)
    : columns_(tiles(width, kTileWidth)), rows_(tiles(height, kTileHeight)) {
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  active_.assign(count, 1);
  low_.resize(count);
  high_.resize(count);
}

void ActivityMap::measure(const Guides& guides, std::span<const ChannelView<const float>> signals,
                          int halo, float tolerance, bool around_zero) {
  const int reach_x = tiles(halo, kTileWidth), reach_y = tiles(halo, kTileHeight);
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  const auto tile_rows = [&](const auto& body) {
    tbb::parallel_for(0, rows_, [&](int row) { body(row); });
  };
  for (const ChannelView<const float>& signal : signals) {
    tile_rows([&](int row) {
      for (int column = 0; column < columns_; ++column) {
        float low = around_zero ? 0.0f : kInfinity, high = around_zero ? 0.0f : -kInfinity;
        const int last_x = std::min((column + 1) * kTileWidth, signal.width);
        const int last_y = std::min((row + 1) * kTileHeight, signal.height);
        for (int y = row * kTileHeight; y < last_y; ++y) {
          const float* depth = guides.depth().row(y);
          const float* value = signal.row(y);
          for (int x = column * kTileWidth; x < last_x; ++x) {
            if (!(depth[x] > 0.0f)) continue;
            low = std::min(low, value[x]);
            high = std::max(high, value[x]);
          }
        }
        low_[static_cast<std::size_t>(row * columns_ + column)] = low;
        high_[static_cast<std::size_t>(row * columns_ + column)] = high;
      }
    });
    tile_rows([&](int row) {
      for (int column = 0; column < columns_; ++column) {
        float low = kInfinity, high = -kInfinity;
        for (int r = std::max(row - reach_y, 0); r <= std::min(row + reach_y, rows_ - 1); ++r)
          for (int c = std::max(column - reach_x, 0); c <= std::min(column + reach_x, columns_ - 1);
               ++c) {
            low = std::min(low, low_[static_cast<std::size_t>(r * columns_ + c)]);
            high = std::max(high, high_[static_cast<std::size_t>(r * columns_ + c)]);
          }
        if (high - low > tolerance) active_[static_cast<std::size_t>(row * columns_ + column)] = 1;
      }
    });
  }
}

double ActivityMap::active_share() const {
  if (active_.empty()) return 0;
  return static_cast<double>(std::count(active_.begin(), active_.end(), std::uint8_t{1})) /
         static_cast<double>(active_.size());
}

}  // namespace holdfast
