#include "core/history/tile_sums.h"

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kLanes = kTilePixels;

/// Sums of a tile by its columns of pixels, so that what is summed in which order does not depend
/// on the instruction set.
struct alignas(64) TileLanes {
  float pixels[kLanes], square[kLanes], difference[3][kLanes], value[3][kLanes];
};

/// One line of pixels, added to the sums of its tiles.
struct TileLine {
  const float *depth, *samples, *history[3], *noisy[3];
  int channels, count;  ///< pixels
  TileLanes* tiles;
};

/// `count` pixels of one tile from x on.
template <int C>
HOLDFAST_INLINE void add_piece(const TileLine& a, int x, int count, TileLanes& tile) {
  const float *depth = a.depth + x, *samples = a.samples + x;
  float known[kLanes];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float lit = samples[i] > 0.0f ? 1.0f : 0.0f;
    known[i] = depth[i] > 0.0f ? lit : 0.0f;
    tile.pixels[i] += known[i];
  }
  for (int c = 0; c < C; ++c) {
    const float *history = a.history[c] + x, *noisy = a.noisy[c] + x;
    float *difference = tile.difference[c], *value = tile.value[c], *square = tile.square;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      const float there = history[i], off = there - noisy[i];
      const float h = known[i] > 0.0f ? there : 0.0f, d = known[i] > 0.0f ? off : 0.0f;
      square[i] += d * d;
      difference[i] += d;
      value[i] += h;
    }
  }
}

template <int C>
HOLDFAST_INLINE void add_line(const TileLine& a) {
  const int whole = a.count / kLanes, left = a.count - whole * kLanes;
  for (int t = 0; t < whole; ++t) add_piece<C>(a, t * kLanes, kLanes, a.tiles[t]);
  if (left > 0) add_piece<C>(a, whole * kLanes, left, a.tiles[whole]);
}

HOLDFAST_INLINE void tile_line_body(const TileLine& a) {
  a.channels == 1 ? add_line<1>(a) : add_line<3>(a);
}

HOLDFAST_KERNEL(tile_line, TileLine)

double sum_of(const float* lanes) {
  double sum = 0;
  for (int i = 0; i < kLanes; ++i) sum += static_cast<double>(lanes[i]);
  return sum;
}

}  // namespace

void sum_tiles(const TileSignal& s, int column, int row, int count, TileSums* sums) {
  TileLanes tiles[kTilesAtOnce];
  std::fill_n(tiles, count, TileLanes{});
  const int x = column * kTilePixels, y = row * kTilePixels;
  TileLine line{};
  line.channels = s.channels;
  line.count = std::min(count * kTilePixels, s.guides.view.width - x);
  line.tiles = tiles;
  const int end = std::min(y + kTilePixels, s.guides.view.height);
  for (int at = y; at < end; ++at) {
    line.depth = s.guides.depth().row(at) + x;
    line.samples = s.samples.row(at) + x;
    for (int c = 0; c < s.channels; ++c) {
      line.history[c] = s.history[c].row(at) + x;
      line.noisy[c] = s.noisy[c].row(at) + x;
    }
    tile_line(line);
  }
  for (int i = 0; i < count; ++i) {
    sums[i] = {sum_of(tiles[i].pixels), sum_of(tiles[i].square), {}, {}};
    for (int c = 0; c < s.channels; ++c) {
      sums[i].difference[c] = sum_of(tiles[i].difference[c]);
      sums[i].value[c] = sum_of(tiles[i].value[c]);
    }
  }
}

}  // namespace holdfast
