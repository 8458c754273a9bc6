#pragma once

#include <limits>

#include "core/history/taps.h"
#include "core/kernels/math.h"

/// Taps of a block of pixels in separate arrays, for the kernels of this folder. Neighbouring
/// pixels mostly come from neighbouring places: of each group of lanes, those whose places follow
/// one another are read together, as they lie in memory. Outputs have room for whole groups. (Loops
/// over a group are not unrolled, since GCC 12 does so before it looks for vectors.)
namespace holdfast {

inline constexpr int kTapBlock = 64;   ///< pixels
inline constexpr int kTapGroup = 16;   ///< lanes that are looked at together
inline constexpr int kMostStarts = 4;  ///< of a group's runs; with more, lanes are read one by one

struct TapLanes {
  int count = 0;  ///< of lanes, 1..kTapBlock
  std::int32_t offset[kTapBlock];
  float weight[4][kTapBlock];
  std::int32_t start[kTapBlock];  ///< offset of lane 0 if it belonged to the run of this lane
  std::int32_t starts[kTapBlock / kTapGroup][kMostStarts];  ///< of a group's runs
  int runs[kTapBlock / kTapGroup];                          ///< their number, or -1: too many
};

inline constexpr std::int32_t kNoStart = std::numeric_limits<std::int32_t>::max();

/// Finds the runs of a group whose `start` is filled. Runs are read for all lanes of a group, which
/// must be inside a channel of the image's size: `last_start` is the last such start of lane 0.
HOLDFAST_INLINE void find_group_runs(TapLanes& lanes, int group, std::int32_t last_start) {
  const std::int32_t* start = lanes.start + group * kTapGroup;
  std::int32_t* starts = lanes.starts[group];
  int runs = 0;
  for (std::int32_t from = std::numeric_limits<std::int32_t>::min();; ++runs) {
    // The least start from `from` on, whose difference is the least: those below wrap around.
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
#pragma GCC unroll 1
    for (int i = 0; i < kTapGroup; ++i)
      least =
          min_of(least, static_cast<std::uint32_t>(start[i]) - static_cast<std::uint32_t>(from));
    const auto next = static_cast<std::int32_t>(static_cast<std::uint32_t>(from) + least);
    if (next == kNoStart || next < from) break;
    if (runs == kMostStarts || next + group * kTapGroup < 0 || next > last_start) {
      lanes.runs[group] = -1;
      return;
    }
    starts[runs] = next;
    from = next + 1;
  }
  lanes.runs[group] = runs;
}

/// Completes lanes whose offsets and weights are filled; `image`: any channel of the size that will
/// be read.
template <class T>
HOLDFAST_INLINE void find_runs(TapLanes& lanes, ChannelView<const T> image) {
  const int whole = (lanes.count + kTapGroup - 1) / kTapGroup * kTapGroup;
  for (int i = lanes.count; i < whole; ++i) {
    lanes.offset[i] = 0;
    for (int k = 0; k < 4; ++k) lanes.weight[k][i] = 0.0f;
  }
  for (int i = 0; i < whole; ++i) {
    const float sum =
        lanes.weight[0][i] + lanes.weight[1][i] + lanes.weight[2][i] + lanes.weight[3][i];
    const std::int32_t own = lanes.offset[i] - i;
    lanes.start[i] = sum > 0.0f ? own : kNoStart;
  }
  const auto last = static_cast<std::int32_t>(
      (image.height - (image.height > 1 ? 1 : 0)) * image.stride - whole - 1);
  for (int group = 0; group * kTapGroup < lanes.count; ++group) find_group_runs(lanes, group, last);
}

/// to[i] = from[offset[i]] where lane i has weight, else 0.
template <class T>
HOLDFAST_INLINE void fetch(const TapLanes& lanes, const T* from, T* to) {
  for (int group = 0; group * kTapGroup < lanes.count; ++group) {
    const int first = group * kTapGroup;
    const std::int32_t *offset = lanes.offset + first, *start = lanes.start + first;
    T* out = to + first;
    if (lanes.runs[group] < 0) {
      for (int i = 0; i < kTapGroup; ++i) out[i] = from[offset[i]];
      continue;
    }
#pragma GCC unroll 1
    for (int i = 0; i < kTapGroup; ++i) out[i] = T(0);
    for (int run = 0; run < lanes.runs[group]; ++run) {
      const std::int32_t begin = lanes.starts[group][run];
      const T* in = from + begin + first;
#pragma GCC ivdep
#pragma GCC unroll 1
      for (int i = 0; i < kTapGroup; ++i) {
        const T there = in[i], kept = out[i];
        out[i] = start[i] == begin ? there : kept;
      }
    }
  }
}

/// Taps as they are kept, into lanes.
template <class T>
HOLDFAST_INLINE void load_lanes(const Taps* taps, int count, ChannelView<const T> image,
                                TapLanes& lanes) {
  lanes.count = count;
  for (int i = 0; i < count; ++i) {
    lanes.offset[i] = taps[i].offset;
    for (int k = 0; k < 4; ++k) lanes.weight[k][i] = taps[i].weight[k];
  }
  find_runs(lanes, image);
}

/// out[i] = `gather` of a channel at lane i.
HOLDFAST_INLINE void gather_lanes(ChannelView<const float> channel, const TapLanes& lanes,
                                  float* out) {
  const std::ptrdiff_t dx = channel.width > 1 ? 1 : 0;
  const std::ptrdiff_t dy = channel.height > 1 ? channel.stride : 0;
  for (int group = 0; group * kTapGroup < lanes.count; ++group) {
    const int first = group * kTapGroup;
    const std::int32_t *offset = lanes.offset + first, *start = lanes.start + first;
    const float *w0 = lanes.weight[0] + first, *w1 = lanes.weight[1] + first,
                *w2 = lanes.weight[2] + first, *w3 = lanes.weight[3] + first;
    float* to = out + first;
    if (lanes.runs[group] < 0) {
      for (int i = 0; i < kTapGroup; ++i) {
        const float* p = channel.data + offset[i];
        to[i] = w0[i] * p[0] + w1[i] * p[dx] + w2[i] * p[dy] + w3[i] * p[dy + dx];
      }
      continue;
    }
#pragma GCC unroll 1
    for (int i = 0; i < kTapGroup; ++i) to[i] = 0.0f;
    for (int run = 0; run < lanes.runs[group]; ++run) {
      const std::int32_t begin = lanes.starts[group][run];
      const float* p = channel.data + begin + first;
      // For the next block: dozens of channels are more streams than a processor follows by itself.
      __builtin_prefetch(p + kTapBlock);
      __builtin_prefetch(p + dy + kTapBlock);
#pragma GCC ivdep
#pragma GCC unroll 1
      for (int i = 0; i < kTapGroup; ++i) {
        const float there =
            w0[i] * p[i] + w1[i] * p[i + dx] + w2[i] * p[i + dy] + w3[i] * p[i + dy + dx];
        const float kept = to[i];
        to[i] = start[i] == begin ? there : kept;
      }
    }
  }
}

}  // namespace holdfast
