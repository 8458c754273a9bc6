#include "core/history/accumulate_kernel.h"

#include <limits>
#include <utility>

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kColumns = kTapBlock + 2;  // of a block, with one neighbour at either end

/// One pixel in the space in which it is clamped: a value, or YCoCg.
struct Clampable {
  float v[3];
};

template <int C>
HOLDFAST_INLINE Clampable clampable(float r, float g, float b) {
  if constexpr (C == 1) return {{r, 0.0f, 0.0f}};
  return {
      {0.25f * r + 0.5f * g + 0.25f * b, 0.5f * r - 0.5f * b, -0.25f * r + 0.5f * g - 0.25f * b}};
}

/// What is known of each column of three pixels: sums, or least and greatest; and in the end what
/// its neighbourhood allows.
struct Columns {
  float sum[3][kColumns], square[3][kColumns], n[kColumns];
  float low[3][kColumns], high[3][kColumns];
};

template <int C>
HOLDFAST_INLINE void clear(Columns& s) {
  for (int j = 0; j < kColumns; ++j) s.n[j] = 0.0f;
  for (int c = 0; c < C; ++c)
    for (int j = 0; j < kColumns; ++j) {
      s.sum[c][j] = s.square[c][j] = 0.0f;
      s.low[c][j] = std::numeric_limits<float>::max();
      s.high[c][j] = std::numeric_limits<float>::lowest();
    }
}

/// Adds the pixels of row qy that are on a surface.
template <int C, bool kBox>
HOLDFAST_INLINE void add_row(const AccumulationBlock& a, int qy, Columns& s) {
  const float* depth = a.guides.depth().row(qy);
  const float *r = a.noisy[0].row(qy), *g = a.noisy[C / 2].row(qy), *b = a.noisy[C - 1].row(qy);
  const int before = a.x - 1;  // the pixel of column 0
  const int first = before < 0 ? 1 : 0;
  const int last = min_of(a.count + 2, a.guides.view.width - before);
#pragma GCC ivdep
  for (int j = first; j < last; ++j) {
    const int q = before + j;
    const Clampable in = clampable<C>(r[q], g[q], b[q]);
    const float there = depth[q] > 0.0f ? 1.0f : 0.0f;
    if constexpr (!kBox) s.n[j] += there;
    for (int c = 0; c < C; ++c) {
      if constexpr (kBox) {
        s.low[c][j] = min_of(s.low[c][j], there > 0.0f ? in.v[c] : s.low[c][j]);
        s.high[c][j] = max_of(s.high[c][j], there > 0.0f ? in.v[c] : s.high[c][j]);
      } else {
        s.sum[c][j] += there * in.v[c];
        s.square[c][j] += there * in.v[c] * in.v[c];
      }
    }
  }
}

/// Least and greatest of nine, and of the pixel itself.
template <int C>
HOLDFAST_INLINE void box_bounds(const AccumulationBlock& a, Columns& s) {
  const float *r = a.noisy[0].row(a.y) + a.x, *g = a.noisy[C / 2].row(a.y) + a.x,
              *b = a.noisy[C - 1].row(a.y) + a.x;
  for (int c = 0; c < C; ++c)
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float own = clampable<C>(r[i], g[i], b[i]).v[c];
      s.low[c][i] = min_of(min_of(s.low[c][i], s.low[c][i + 1]), min_of(s.low[c][i + 2], own));
      s.high[c][i] = max_of(max_of(s.high[c][i], s.high[c][i + 1]), max_of(s.high[c][i + 2], own));
    }
}

/// Mean +- gamma sigma of nine.
template <int C>
HOLDFAST_INLINE void deviation_bounds(const AccumulationBlock& a, Columns& s) {
  const float gamma = a.rule.clamp_gamma;
  for (int c = 0; c < C; ++c)
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float inverse = 1.0f / (s.n[i] + s.n[i + 1] + s.n[i + 2]);
      const float mean = (s.sum[c][i] + s.sum[c][i + 1] + s.sum[c][i + 2]) * inverse;
      const float square = (s.square[c][i] + s.square[c][i + 1] + s.square[c][i + 2]) * inverse;
      const float sigma = __builtin_sqrtf(max_of(square - mean * mean, 0.0f));
      s.low[c][i] = mean - gamma * sigma;
      s.high[c][i] = mean + gamma * sigma;
    }
}

HOLDFAST_INLINE float clamp_to(float v, float low, float high) {
  return min_of(max_of(v, low), high);
}

/// Clamps history to what the 3x3 neighbourhoods of its pixels allow. Clamping each axis on its own
/// may leave the colours that exist; those are brought back to 0.
template <int C, bool kBox>
HOLDFAST_INLINE void rectify(const AccumulationBlock& a, const float* clamped,
                             float (*history)[kTapBlock]) {
  Columns s;
  clear<C>(s);
  const int first = max_of(a.y - 1, 0), last = min_of(a.y + 1, a.guides.view.height - 1);
  for (int qy = first; qy <= last; ++qy) add_row<C, kBox>(a, qy, s);
  if constexpr (kBox)
    box_bounds<C>(a, s);
  else
    deviation_bounds<C>(a, s);
  float *h0 = history[0], *h1 = history[C / 2], *h2 = history[C - 1];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float r = h0[i], g = h1[i], b = h2[i];
    const Clampable in = clampable<C>(r, g, b);
    const float y = clamp_to(in.v[0], s.low[0][i], s.high[0][i]);
    if constexpr (C == 1) {
      h0[i] = clamped[i] > 0.0f ? y : r;
    } else {
      const float o = clamp_to(in.v[1], s.low[1][i], s.high[1][i]);
      const float p = clamp_to(in.v[2], s.low[2][i], s.high[2][i]);
      h0[i] = clamped[i] > 0.0f ? max_of(y + o - p, 0.0f) : r;
      h1[i] = clamped[i] > 0.0f ? max_of(y + p, 0.0f) : g;
      h2[i] = clamped[i] > 0.0f ? max_of(y - o - p, 0.0f) : b;
    }
  }
}

HOLDFAST_INLINE void blend_channel(const AccumulationBlock& a, const float* in,
                                   const float* history, float* out) {
  const float* weight = a.history_weight;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) out[i] = (1.0f - weight[i]) * in[i] + weight[i] * history[i];
}

/// The first two moments of the luminance, by the same blend.
HOLDFAST_INLINE void blend_moments(const AccumulationBlock& a, const TapLanes& lanes) {
  const int last = a.now.channels - 1;
  const float *r = a.noisy[0].row(a.y) + a.x, *g = a.noisy[last / 2].row(a.y) + a.x,
              *b = a.noisy[last].row(a.y) + a.x;
  float history[kTapBlock], moment[kTapBlock];
  for (int order = 1; order <= 2; ++order) {
    gather_lanes(a.before.moment(order), lanes, history);
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float l = last == 0 ? r[i] : luminance(r[i], g[i], b[i]);
      moment[i] = order == 1 ? l : l * l;
    }
    blend_channel(a, moment, history, a.now.moment(order).row(a.y) + a.x);
  }
}

/// The trust in each pixel's history, 0 where there is none, and whether it is clamped; returns
/// whether any is.
HOLDFAST_INLINE bool weigh(const AccumulationBlock& a, const TapLanes& lanes, float* trust,
                           float* clamped) {
  const float of_surface = a.lanes.clamp_surface ? 1.0f : 0.0f;
  const float of_effect = a.lanes.clamp_effect ? 1.0f : 0.0f;
  for (int i = 0; i < a.count; ++i) {
    trust[i] = lanes.start[i] != kNoStart ? 1.0f : 0.0f;
    clamped[i] = of_surface * trust[i];
  }
  if (a.lanes.effect != nullptr)
    for (int i = 0; i < a.count; ++i)
      clamped[i] = trust[i] * (a.lanes.effect[i] > 0.0f ? of_effect : of_surface);
  if (a.lanes.trust != nullptr)
    for (int i = 0; i < a.count; ++i) trust[i] *= a.lanes.trust[i];
  int any = 0;
  for (int i = 0; i < a.count; ++i) any |= clamped[i] > 0.0f ? 1 : 0;
  return any != 0;
}

HOLDFAST_INLINE void accumulate_kernel_body(const AccumulationBlock& a) {
  TapLanes lanes;
  load_lanes(a.lanes.taps, a.count, a.guides.depth(), lanes);
  const int channels = a.now.channels;
  float history[3][kTapBlock];
  for (int c = 0; c < channels; ++c) gather_lanes(a.before.data[c], lanes, history[c]);
  gather_lanes(a.before.samples(), lanes, a.history_samples);
  float trust[kTapBlock], clamped[kTapBlock];
  if (weigh(a, lanes, trust, clamped)) {
    const bool box = a.rule.rectification == Rectification::kClampBox;
    if (channels == 1)
      box ? rectify<1, true>(a, clamped, history) : rectify<1, false>(a, clamped, history);
    else
      box ? rectify<3, true>(a, clamped, history) : rectify<3, false>(a, clamped, history);
  }
  const float alpha = a.rule.alpha, most = (2.0f - alpha) / alpha;
  const float* n = a.history_samples;
  float *weight = a.history_weight, *samples = a.now.samples().row(a.y) + a.x;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    weight[i] = trust[i] * (1.0f - max_of(alpha, 1.0f / (n[i] + 1.0f)));
    samples[i] = min_of(1.0f + trust[i] * n[i], most);
  }
  for (int c = 0; c < channels; ++c)
    blend_channel(a, a.noisy[c].row(a.y) + a.x, history[c], a.signal[c].row(a.y) + a.x);
  if (a.now.has_moments()) blend_moments(a, lanes);
}

HOLDFAST_KERNEL(accumulate_kernel, AccumulationBlock)

}  // namespace

void accumulate_block(const AccumulationBlock& block) noexcept { accumulate_kernel(block); }

}  // namespace holdfast
