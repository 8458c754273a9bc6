#include "core/spatial/activity.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int tiles(int pixels, int size) { return (pixels + size - 1) / size; }
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// One row of tiles: smallest and largest value of a signal where `where` is positive.
struct TileRanges {
  ChannelView<const float> where, signal;
  int first_y, last_y;
  float low, high;  ///< to begin with
  float *low_out, *high_out;
};

constexpr int kTilesAtOnce = 16;
constexpr int kPiece = kTilesAtOnce * ActivityMap::kTileWidth;  // pixels

/// Ranges of the columns of `count` pixels from x0 on.
HOLDFAST_INLINE void widen(const TileRanges& a, int x0, int count, float* __restrict low,
                           float* __restrict high) {
  for (int y = a.first_y; y < a.last_y; ++y) {
    const float* __restrict where = a.where.row(y) + x0;
    const float* __restrict value = a.signal.row(y) + x0;
    for (int i = 0; i < count; ++i) {
      const float there = where[i], given = value[i], least = low[i], most = high[i];
      const float lower = given < least ? given : least, higher = given > most ? given : most;
      low[i] = there > 0.0f ? lower : least;
      high[i] = there > 0.0f ? higher : most;
    }
  }
}

HOLDFAST_INLINE void tile_ranges_body(const TileRanges& a) {
  constexpr int kTile = ActivityMap::kTileWidth;
  const int width = a.signal.width;
  for (int x0 = 0; x0 < width; x0 += kPiece) {
    const int count = min_of(kPiece, width - x0), tiles = (count + kTile - 1) / kTile;
    float low[kPiece], high[kPiece];
    for (int i = 0; i < tiles * kTile; ++i) low[i] = a.low;
    for (int i = 0; i < tiles * kTile; ++i) high[i] = a.high;
    widen(a, x0, count, low, high);
    // Neighbours are joined until one value a tile is left.
    float low_of[kPiece / 2], high_of[kPiece / 2];
    for (int left = tiles * kTile / 2; left >= tiles; left /= 2) {
      for (int i = 0; i < left; ++i) low_of[i] = min_of(low[2 * i], low[2 * i + 1]);
      for (int i = 0; i < left; ++i) high_of[i] = max_of(high[2 * i], high[2 * i + 1]);
      for (int i = 0; i < left; ++i) low[i] = low_of[i];
      for (int i = 0; i < left; ++i) high[i] = high_of[i];
    }
    float *low_out = a.low_out + x0 / kTile, *high_out = a.high_out + x0 / kTile;
    for (int i = 0; i < tiles; ++i) low_out[i] = low[i];
    for (int i = 0; i < tiles; ++i) high_out[i] = high[i];
  }
}

HOLDFAST_KERNEL(tile_ranges, TileRanges)

constexpr int kBlock = 64;  // tiles of a row

/// Widens ranges to those of other tiles.
void widen(const float* __restrict from_low, const float* __restrict from_high, int count,
           float* __restrict low, float* __restrict high) {
  for (int i = 0; i < count; ++i) {
    low[i] = from_low[i] < low[i] ? from_low[i] : low[i];
    high[i] = from_high[i] > high[i] ? from_high[i] : high[i];
  }
}

}  // namespace

ActivityMap::ActivityMap(int width, int height)
    : columns_(tiles(width, kTileWidth)), rows_(tiles(height, kTileHeight)) {
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  zone_.assign(count, 0);
  for (std::vector<float>* v : {&low_, &high_, &row_low_, &row_high_}) v->resize(count);
}

void ActivityMap::measure(const Guides& guides, std::span<const ChannelView<const float>> signals,
                          std::span<const int> halos, float tolerance, bool around_zero) {
  std::fill(zone_.begin(), zone_.end(), kRest);
  for (const ChannelView<const float>& signal : signals) {
    measure_ranges(guides.depth(), signal, around_zero);
    for (std::size_t zone = 0; zone < halos.size(); ++zone)
      mark(halos[zone], static_cast<int>(zone), tolerance);
  }
}

void ActivityMap::measure_below(ChannelView<const float> values, float limit, int halo) {
  std::fill(zone_.begin(), zone_.end(), kRest);
  measure_ranges(values, values, false);
  for (std::size_t tile = 0; tile < zone_.size(); ++tile) {
    high_[tile] = low_[tile] < limit ? 1.0f : 0.0f;
    low_[tile] = 0.0f;
  }
  mark(halo, 0, 0.0f);
}

void ActivityMap::measure_ranges(ChannelView<const float> where, ChannelView<const float> signal,
                                 bool around_zero) {
  for_each_index(0, rows_, 1, [&](int row) {
    tile_ranges({where, signal, row * kTileHeight, std::min((row + 1) * kTileHeight, signal.height),
                 around_zero ? 0.0f : kInfinity, around_zero ? 0.0f : -kInfinity, &low_[at(row, 0)],
                 &high_[at(row, 0)]});
  });
}

void ActivityMap::mark(int halo, int zone, float tolerance) {
  const int reach_x = tiles(halo, kTileWidth), reach_y = tiles(halo, kTileHeight);
  for_each_index(0, rows_, 1, [&](int row) {
    const float *low = &low_[at(row, 0)], *high = &high_[at(row, 0)];
    float *row_low = &row_low_[at(row, 0)], *row_high = &row_high_[at(row, 0)];
    std::copy_n(low, columns_, row_low);
    std::copy_n(high, columns_, row_high);
    for (int reach = 1; reach <= std::min(reach_x, columns_ - 1); ++reach) {
      const int both = columns_ - reach;  // tiles that have another one so far to one side
      widen(low + reach, high + reach, both, row_low, row_high);
      widen(low, high, both, row_low + reach, row_high + reach);
    }
  });
  for_each_index(0, rows_, 1, [&](int row) {
    const int first = std::max(row - reach_y, 0), last = std::min(row + reach_y, rows_ - 1);
    for (int column = 0; column < columns_; column += kBlock) {
      const int count = std::min(kBlock, columns_ - column);
      float low[kBlock], high[kBlock];
      std::copy_n(&row_low_[at(first, column)], count, low);
      std::copy_n(&row_high_[at(first, column)], count, high);
      for (int r = first + 1; r <= last; ++r)
        widen(&row_low_[at(r, column)], &row_high_[at(r, column)], count, low, high);
      std::uint8_t* narrowest = &zone_[at(row, column)];
      for (int i = 0; i < count; ++i)
        if (high[i] - low[i] > tolerance * std::max(high[i], -low[i]) && narrowest[i] > zone)
          narrowest[i] = static_cast<std::uint8_t>(zone);
    }
  });
}

double ActivityMap::active_share(int zone) const {
  if (zone_.empty()) return 0;
  return static_cast<double>(
             std::count_if(zone_.begin(), zone_.end(), [&](std::uint8_t z) { return z <= zone; })) /
         static_cast<double>(zone_.size());
}

}  // namespace holdfast
