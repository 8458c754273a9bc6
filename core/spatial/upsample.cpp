#include "core/spatial/upsample.h"

#include <algorithm>
#include <limits>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/spatial/guided_filter.h"
#include "core/spatial/tangent_planes.h"

namespace holdfast {
namespace {

constexpr int kBlock = 64;              // pixels
constexpr int kHalfBlock = kBlock / 2;  // of either parity, and half pixels below them
constexpr float kTolerancePx = 2.0f;    // half pixels are two wide
constexpr float kNormalPower = FilterWeights{}.normal_power;
constexpr float kOne = 65535.0f;  // of 16 bits

// How weights are kept: blocks of 64 pixels of a row, first their even pixels, then the odd ones.
// A pixel has two words, one for either row of half pixels: in its lower half the weight of the
// nearer half pixel, in the upper half that of the farther one. Words of a pixel without surface
// are 0. Where another half pixel stands in, the first word is 0 and the second says which one:
// weights of the nearest would sum up to kOne.
enum Row { kNear, kFar, kRows };
enum Tap { kNearer, kFarther, kTaps };
// What a block has, in a byte.
constexpr std::uint8_t kHasSky = 1, kHasStandIns = 2;

// The 5x5 half pixels that may stand in, by number.
constexpr int kReach = 2, kSide = 2 * kReach + 1;
std::uint32_t stand_in_number(int dx, int dy) {
  return static_cast<std::uint32_t>(1 + (dy + kReach) * kSide + dx + kReach);
}

/// `count` pixels from (x0, y) on, whose weights are to be found; x0 is even.
struct FindBlock {
  const Guides *full, *half;
  int x0, count, y;
  std::uint32_t* words[kRows];  ///< of the block
  float* sums;                  ///< of g
  std::uint8_t* has;
};

/// The pixels of a block, the even ones and the odd ones: of each kind, neighbours have
/// neighbouring half pixels. Beyond the block's end, anything.
struct Pixels {
  float plane_0[2][kHalfBlock], plane_x[2][kHalfBlock], plane_y[2][kHalfBlock];
  float offset_0[2][kHalfBlock], offset_x[2][kHalfBlock], offset_y[2][kHalfBlock];
  float nx[2][kHalfBlock], ny[2][kHalfBlock], nz[2][kHalfBlock];
  std::uint32_t id[2][kHalfBlock];
};

/// Half pixels of a row: those below a block, one before them and one behind. Outside the image
/// there is no surface, which weighs nothing.
struct HalfPixels {
  static constexpr int kRoom = kHalfBlock + 16;
  float depth[kRoom], nx[kRoom], ny[kRoom], nz[kRoom];
  std::uint32_t id[kRoom];
};

/// Weights of a block, by parity of the pixels.
struct Weights {
  float g[kRows][kTaps][2][kHalfBlock];
};

template <class T>
HOLDFAST_INLINE void part(const T (&from)[kBlock], T (&to)[2][kHalfBlock]) {
  for (int j = 0; j < kHalfBlock; ++j) {
    to[0][j] = from[2 * j];
    to[1][j] = from[2 * j + 1];
  }
}

HOLDFAST_INLINE void load_pixels(const Guides& full, int x0, int count, int y, Pixels& p) {
  TangentPlanes<kBlock> planes{};
  load_tangent_planes(full, kTolerancePx, x0, y, count, planes);
  for (float* normal : {planes.nx, planes.ny, planes.nz})
    for (int i = 0; i < kBlock; ++i) normal[i] *= kNormalPower;
  std::uint32_t id[kBlock] = {};
  const std::uint32_t* __restrict row = full.id[0].row(y) + x0;
  for (int i = 0; i < count; ++i) id[i] = row[i];
  part(planes.plane_0, p.plane_0);
  part(planes.plane_x, p.plane_x);
  part(planes.plane_y, p.plane_y);
  part(planes.offset_0, p.offset_0);
  part(planes.offset_x, p.offset_x);
  part(planes.offset_y, p.offset_y);
  part(planes.nx, p.nx);
  part(planes.ny, p.ny);
  part(planes.nz, p.nz);
  part(id, p.id);
}

/// The values of a row around the half pixels from q0 on; zeros outside the image.
template <class T>
HOLDFAST_INLINE void copy_around(const T* row, int width, int q0, T (&to)[HalfPixels::kRoom]) {
  for (int i = 0; i < HalfPixels::kRoom; ++i) to[i] = T(0);
  const int first = q0 > 0 ? 0 : 1, end = min_of(kHalfBlock + 2, width - q0 + 1);
  for (int i = first; i < end; ++i) to[i] = row[q0 - 1 + i];
}

HOLDFAST_INLINE void load_half(const Guides& half, int q0, int qy, HalfPixels& h) {
  const int width = half.view.width;
  copy_around(half.depth().row(qy), width, q0, h.depth);
  copy_around(half.normal(0).row(qy), width, q0, h.nx);
  copy_around(half.normal(1).row(qy), width, q0, h.ny);
  copy_around(half.normal(2).row(qy), width, q0, h.nz);
  copy_around(half.id[0].row(qy), width, q0, h.id);
}

/// The weights for the pixels of one parity of the half pixels `at` places behind their own's, of
/// which the first is at 1, and whose middles lie (dx, dy) full pixels away; `bits`: weight_bits
/// of b.
HOLDFAST_INLINE void weigh_half(const HalfPixels& h, int at, float dx, float dy, float bits,
                                const Pixels& p, int parity, float* __restrict g) {
  const float *depth = h.depth + at, *nx = h.nx + at, *ny = h.ny + at, *nz = h.nz + at;
  const std::uint32_t* half_id = h.id + at;
#pragma GCC ivdep
  for (int j = 0; j < kHalfBlock; ++j) {
    const float plane =
        p.plane_0[parity][j] + dx * p.plane_x[parity][j] + dy * p.plane_y[parity][j];
    const float offset =
        p.offset_0[parity][j] + dx * p.offset_x[parity][j] + dy * p.offset_y[parity][j];
    const float e = depth[j] * plane + offset;
    const float turned =
        kNormalPower - p.nx[parity][j] * nx[j] - p.ny[parity][j] * ny[j] - p.nz[parity][j] * nz[j];
    const float weight = weight_exp(bits, abs_of(e) + positive_part(turned));
    const float alike = half_id[j] == p.id[parity][j] ? weight : 0.0f;
    g[j] = depth[j] > 0.0f ? alike : 0.0f;
  }
}

/// Those of row qy, which lies `dy` full pixels below the block; `bits`: of its nearer and farther
/// half pixels.
HOLDFAST_INLINE void weigh_row(const Guides& half, int q0, int qy, float dy, float near_bits,
                               float far_bits, const Pixels& p, float (&g)[kTaps][2][kHalfBlock]) {
  HalfPixels h;
  load_half(half, q0, qy, h);
  weigh_half(h, 1, 0.5f, dy, near_bits, p, 0, g[kNearer][0]);
  weigh_half(h, 0, -1.5f, dy, far_bits, p, 0, g[kFarther][0]);
  weigh_half(h, 1, -0.5f, dy, near_bits, p, 1, g[kNearer][1]);
  weigh_half(h, 2, 1.5f, dy, far_bits, p, 1, g[kFarther][1]);
}

template <class T>
HOLDFAST_INLINE void join(const T (&from)[2][kHalfBlock], T (&to)[kBlock]) {
  for (int j = 0; j < kHalfBlock; ++j) {
    to[2 * j] = from[0][j];
    to[2 * j + 1] = from[1][j];
  }
}

/// Two weights in 0..kOne, the lower half's first.
HOLDFAST_INLINE std::uint32_t word_of(float lower, float upper) {
  const auto low = static_cast<std::int32_t>(lower + 0.5f);
  const auto high = static_cast<std::int32_t>(upper + 0.5f);
  return static_cast<std::uint32_t>(low) | static_cast<std::uint32_t>(high) << 16;
}

/// The row of half pixels that is farther from row y than its own.
HOLDFAST_INLINE int far_row(int y) { return (y >> 1) + 2 * (y & 1) - 1; }

HOLDFAST_INLINE void find_upsampling_body(const FindBlock& a) {
  const int q0 = a.x0 / 2, far = far_row(a.y);
  Pixels pixels;
  load_pixels(*a.full, a.x0, a.count, a.y, pixels);
  Weights weights{};
  // Of 9, 3, 3 and 1 sixteenths.
  const float most = weight_bits(-0.830074999f), some = weight_bits(-2.415037499f),
              least = weight_bits(-4.0f);
  const float below = (a.y & 1) != 0 ? -0.5f : 0.5f;
  weigh_row(*a.half, q0, a.y >> 1, below, most, some, pixels, weights.g[kNear]);
  if (far >= 0 && far < a.half->view.height)
    weigh_row(*a.half, q0, far, -3.0f * below, some, least, pixels, weights.g[kFar]);
  float depth[kBlock] = {}, parted[2][kHalfBlock], sums[2][kHalfBlock], all[kBlock];
  const float* __restrict row = a.full->depth().row(a.y) + a.x0;
  for (int i = 0; i < a.count; ++i) depth[i] = row[i];
  part(depth, parted);
  for (int parity = 0; parity < 2; ++parity) {
    std::uint32_t* __restrict near_words = a.words[kNear] + parity * kHalfBlock;
    std::uint32_t* __restrict far_words = a.words[kFar] + parity * kHalfBlock;
    const auto& g = weights.g;
#pragma GCC ivdep
    for (int j = 0; j < kHalfBlock; ++j) {
      const float g0 = g[kNear][kNearer][parity][j], g1 = g[kNear][kFarther][parity][j],
                  g2 = g[kFar][kNearer][parity][j], g3 = g[kFar][kFarther][parity][j];
      const float sum = g0 + g1 + g2 + g3;
      const float found = kOne / max_of(sum, 1e-20f);
      const float scale = parted[parity][j] > 0.0f ? found : 0.0f;
      near_words[j] = word_of(g0 * scale, g1 * scale);
      far_words[j] = word_of(g2 * scale, g3 * scale);
      sums[parity][j] = sum;
    }
  }
  join(sums, all);
  int sky = 0, poor = 0;
  for (int i = 0; i < a.count; ++i) {
    sky += depth[i] > 0.0f ? 0 : 1;
    poor += depth[i] > 0.0f && all[i] < Upsampling::kLeastWeight ? 1 : 0;
    a.sums[i] = all[i];
  }
  *a.has = static_cast<std::uint8_t>((sky > 0 ? kHasSky : 0) | (poor > 0 ? kHasStandIns : 0));
}

HOLDFAST_KERNEL(find_upsampling, FindBlock)

/// `count` pixels from (x0, y) on, of a signal.
struct ApplyBlock {
  const Upsampling::Signal* signal;
  int x0, count, y;
  const std::uint32_t* words[kRows];  ///< of the block
  bool has_sky;
};

/// Weights of sum 1 from words; shown[i]: pixel i has any.
HOLDFAST_INLINE void load_weights(const ApplyBlock& a, Weights& weights, float (&shown)[kBlock]) {
  float any[2][kHalfBlock];
  auto& g = weights.g;
  for (int parity = 0; parity < 2; ++parity) {
    const std::uint32_t* __restrict near_words = a.words[kNear] + parity * kHalfBlock;
    const std::uint32_t* __restrict far_words = a.words[kFar] + parity * kHalfBlock;
#pragma GCC ivdep
    for (int j = 0; j < kHalfBlock; ++j) {
      const auto w0 = static_cast<float>(static_cast<std::int32_t>(near_words[j] & 0xffffu)),
                 w1 = static_cast<float>(static_cast<std::int32_t>(near_words[j] >> 16)),
                 w2 = static_cast<float>(static_cast<std::int32_t>(far_words[j] & 0xffffu)),
                 w3 = static_cast<float>(static_cast<std::int32_t>(far_words[j] >> 16));
      const float sum = w0 + w1 + w2 + w3, scale = 1.0f / max_of(sum, 1.0f);
      g[kNear][kNearer][parity][j] = w0 * scale;
      g[kNear][kFarther][parity][j] = w1 * scale;
      g[kFar][kNearer][parity][j] = w2 * scale;
      g[kFar][kFarther][parity][j] = w3 * scale;
      any[parity][j] = sum;
    }
  }
  join(any, shown);
}

HOLDFAST_INLINE void apply_upsampling_body(const ApplyBlock& a) {
  const Upsampling::Signal& signal = *a.signal;
  const int q0 = a.x0 / 2, near = a.y >> 1, far = far_row(a.y);
  Weights weights;
  float shown[kBlock];
  load_weights(a, weights, shown);
  const auto& g = weights.g;
  for (int c = 0; c < signal.channels; ++c) {
    const ChannelView<const float>& in = signal.in[c];
    float in_near[HalfPixels::kRoom], in_far[HalfPixels::kRoom];
    copy_around(in.row(near), in.width, q0, in_near);
    // Weighs nothing where there is none.
    copy_around(in.row(far >= 0 && far < in.height ? far : near), in.width, q0, in_far);
    float means[2][kHalfBlock], value[kBlock];
    for (int parity = 0; parity < 2; ++parity) {
      const float* farther_near = in_near + 2 * parity;
      const float* farther_far = in_far + 2 * parity;
      for (int j = 0; j < kHalfBlock; ++j)
        means[parity][j] = g[kNear][kNearer][parity][j] * in_near[1 + j] +
                           g[kNear][kFarther][parity][j] * farther_near[j] +
                           g[kFar][kNearer][parity][j] * in_far[1 + j] +
                           g[kFar][kFarther][parity][j] * farther_far[j];
    }
    join(means, value);
    float* __restrict out = signal.out[c].row(a.y) + a.x0;
    if (a.has_sky) {
      const float* __restrict beyond = signal.beyond[c].row(a.y) + a.x0;
      for (int i = 0; i < a.count; ++i) out[i] = shown[i] > 0.0f ? value[i] : beyond[i];
    } else {
      for (int i = 0; i < a.count; ++i) out[i] = value[i];
    }
  }
}

HOLDFAST_KERNEL(apply_upsampling, ApplyBlock)

/// How unlike half pixel (qx, qy), which shows a surface, is what pixel (x, y) shows.
struct Unlike {
  bool foreign = true;  ///< of another id: more unlike than anything of the same
  float by = std::numeric_limits<float>::infinity();
  bool operator<(const Unlike& other) const {
    return foreign != other.foreign ? other.foreign : by < other.by;
  }
};

Unlike difference(const Guides& full, const Guides& half, int x, int y, int qx, int qy) {
  const glm::vec3 n = full.normal_at(x, y);
  const float width_m = static_cast<float>(full.view.pixel_angle) *
                        (full.rays.near_weight + full.rays.far_weight * full.depth().at(x, y));
  const float distance = glm::dot(n, half.position_at(qx, qy) - full.position_at(x, y));
  const float dx = static_cast<float>(qx) + 0.5f - 0.5f * (static_cast<float>(x) + 0.5f);
  const float dy = static_cast<float>(qy) + 0.5f - 0.5f * (static_cast<float>(y) + 0.5f);
  return {full.id[0].at(x, y) != half.id[0].at(qx, qy),
          std::abs(distance) / (kTolerancePx * width_m) +
              kNormalPower * std::max(1.0f - glm::dot(n, half.normal_at(qx, qy)), 0.0f) +
              0.5f * (dx * dx + dy * dy)};
}

/// The number of the half pixel that stands in for pixel (x, y).
std::uint32_t find_stand_in(const Guides& full, const Guides& half, int x, int y) {
  const int last_x = half.view.width - 1, last_y = half.view.height - 1;
  const int own_x = x / 2, own_y = y / 2;
  std::uint32_t best = stand_in_number(0, 0);
  Unlike least;
  for (int qy = std::max(own_y - kReach, 0); qy <= std::min(own_y + kReach, last_y); ++qy)
    for (int qx = std::max(own_x - kReach, 0); qx <= std::min(own_x + kReach, last_x); ++qx) {
      if (!(half.depth().at(qx, qy) > 0.0f)) continue;
      const Unlike d = difference(full, half, x, y, qx, qy);
      if (!(d < least)) continue;
      least = d;
      best = stand_in_number(qx - own_x, qy - own_y);
    }
  return best;
}

/// Pixel (x, y) shows half pixel `number`.
void show_stand_in(const Upsampling::Signal& signal, int x, int y, std::uint32_t number) {
  const int at = static_cast<int>(number) - 1;
  const int qx = x / 2 + at % kSide - kReach, qy = y / 2 + at / kSide - kReach;
  for (int c = 0; c < signal.channels; ++c) signal.out[c].at(x, y) = signal.in[c].at(qx, qy);
}

/// Where the word of pixel `i` of a block is.
int place_of(int i) { return i % 2 * kHalfBlock + i / 2; }

int blocks_of(int width) { return (width + kBlock - 1) / kBlock; }

}  // namespace

Upsampling::Upsampling(int width, int height, Memory memory)
    : width_(width),
      words_(blocks_of(width) * kBlock, height, kRows, memory),
      blocks_(static_cast<std::size_t>(blocks_of(width)) * static_cast<std::size_t>(height)) {}

void Upsampling::find(const Guides& full, const Guides& half) {
  for_each_row(words_.height(), [&](int y) {
    const auto depth = full.depth();
    float sums[kBlock];
    for (int b = 0; b < blocks_of(width_); ++b) {
      const int x0 = b * kBlock, count = std::min(kBlock, width_ - x0);
      std::uint32_t* words[kRows] = {words_[kNear].row(y) + x0, words_[kFar].row(y) + x0};
      std::uint8_t& has = blocks_[static_cast<std::size_t>(y * blocks_of(width_) + b)];
      find_upsampling({&full, &half, x0, count, y, {words[kNear], words[kFar]}, sums, &has});
      if ((has & kHasStandIns) == 0) continue;
      for (int i = 0; i < count; ++i) {
        if (!(depth.at(x0 + i, y) > 0.0f && sums[i] < kLeastWeight)) continue;
        words[kNear][place_of(i)] = 0;
        words[kFar][place_of(i)] = find_stand_in(full, half, x0 + i, y);
      }
    }
  });
}

void Upsampling::run(const Signal& signal) const {
  for_each_row(words_.height(), [&](int y) {
    for (int b = 0; b < blocks_of(width_); ++b) {
      const int x0 = b * kBlock, count = std::min(kBlock, width_ - x0);
      const std::uint32_t *near = words_[kNear].row(y) + x0, *far = words_[kFar].row(y) + x0;
      const std::uint8_t has = blocks_[static_cast<std::size_t>(y * blocks_of(width_) + b)];
      apply_upsampling({&signal, x0, count, y, {near, far}, (has & kHasSky) != 0});
      if ((has & kHasStandIns) == 0) continue;
      for (int i = 0; i < count; ++i) {
        const std::uint32_t number = far[place_of(i)];
        if (near[place_of(i)] == 0 && number >= 1 && number <= kSide * kSide)
          show_stand_in(signal, x0 + i, y, number);
      }
    }
  });
}

}  // namespace holdfast
