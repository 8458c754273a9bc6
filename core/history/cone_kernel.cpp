#include "core/history/cone_kernel.h"

#include <limits>
#include <utility>

#include "core/kernels/variants.h"
#include "core/motion/plain_math.h"

namespace holdfast {
namespace {

constexpr float kNoLight = 1e-30f;  // luminance that has no hue: dividing by less may overflow

HOLDFAST_INLINE void recall_body(const ConeRecall& a) {
  TapLanes lanes;
  load_lanes(a.taps, a.rows.count, a.previous.depth(), lanes);
  for (int c = 0; c < a.kept.count(); ++c) gather_lanes(a.kept[c], lanes, a.rows.of[c]);
  for (int axis = 0; axis < 3; ++axis) gather_lanes(a.previous.normal(axis), lanes, a.before[axis]);
  const float *bx = a.before[0], *by = a.before[1], *bz = a.before[2];
  const float *nx = a.normal[0], *ny = a.normal[1], *nz = a.normal[2];
  std::uint8_t* turned = a.turned;
  const int count = a.rows.count;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const Float3 from{bx[i], by[i], bz[i]};
    const float same = kSameConesCosine * __builtin_sqrtf(dot(from, from));
    turned[i] = dot(from, {nx[i], ny[i], nz[i]}) < same ? 1 : 0;
  }
}

/// Axes of the cones of a surface whose normal is the pole of ConeFrame.
struct RestingAxes {
  Float3 of[kCones];
};

/// The cone of each pixel's direction (ConeFrame::nearest), or -1.
HOLDFAST_INLINE void find_cones(const ConeCorrection& a, const RestingAxes& axes, float* cone) {
  const Float3 pole = axes.of[0], a1 = axes.of[1], a2 = axes.of[2], a3 = axes.of[3],
               a4 = axes.of[4], a5 = axes.of[5];
  const float *nx = a.normal[0], *ny = a.normal[1], *nz = a.normal[2];
  const float *dx = a.direction[0], *dy = a.direction[1], *dz = a.direction[2];
#pragma GCC ivdep
  for (int i = 0; i < a.rows.count; ++i) {
    const Float3 n{nx[i], ny[i], nz[i]}, d{dx[i], dy[i], dz[i]};
    // The rotation of ConeFrame, the other way.
    const Float3 turn{pole.y * n.z - pole.z * n.y, pole.z * n.x - pole.x * n.z,
                      pole.x * n.y - pole.y * n.x};
    const float sine2 = dot(turn, turn), given = dot(pole, n);
    const bool opposite = sine2 <= 1e-8f && given < 0.0f;
    const float cosine = opposite ? -1.0f : given, whole = opposite ? 0.0f : 1.0f;
    const float over = given >= 0.0f ? 1.0f : 1.0f - given;
    const float under = given >= 0.0f ? 1.0f + given : max_of(sine2, 1e-8f);
    const float along = whole * dot(turn, d) * over / under;
    const Float3 resting{cosine * d.x + whole * (turn.z * d.y - turn.y * d.z) + along * turn.x,
                         cosine * d.y + whole * (turn.x * d.z - turn.z * d.x) + along * turn.y,
                         cosine * d.z + whole * (turn.y * d.x - turn.x * d.y) + along * turn.z};
    const float c0 = dot(resting, pole), c1 = dot(resting, a1), c2 = dot(resting, a2),
                c3 = dot(resting, a3), c4 = dot(resting, a4), c5 = dot(resting, a5);
    float best = 0.0f, most = c0;
    best = c1 > most ? 1.0f : best;
    most = max_of(c1, most);
    best = c2 > most ? 2.0f : best;
    most = max_of(c2, most);
    best = c3 > most ? 3.0f : best;
    most = max_of(c3, most);
    best = c4 > most ? 4.0f : best;
    most = max_of(c4, most);
    best = c5 > most ? 5.0f : best;
    const float above = dot(d, n);
    const float finite = above <= std::numeric_limits<float>::max() ? best : -1.0f;
    const float sampled = above > 0.0f ? finite : -1.0f;
    cone[i] = a.depth[i] > 0.0f ? sampled : -1.0f;
  }
}

/// total[i] = sum of the channels of six cones.
HOLDFAST_INLINE void add_up(float* const* of, int count, float* total) {
  const float *s0 = of[0], *s1 = of[1], *s2 = of[2], *s3 = of[3], *s4 = of[4], *s5 = of[5];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) total[i] = s0[i] + s1[i] + s2[i] + s3[i] + s4[i] + s5[i];
}

/// L_k - sum_j W_j L_j of one colour, k the pixel's cone; 0 where nothing is known or sampled.
HOLDFAST_INLINE void find_excess(const ConeCorrection& a, int colour, const float* cone,
                                 const float* known, const float* total, float* excess) {
  const int count = a.rows.count;
  const float prior = a.prior_samples;
  float lean[kTapBlock], mean[kTapBlock], own[kTapBlock];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    lean[i] = prior * total[i] / (known[i] > 0.0f ? known[i] : 1.0f);
    mean[i] = 0.0f;
    own[i] = 0.0f;
  }
  for (int k = 0; k < kCones; ++k) {
    const float *sum = a.rows.sum(colour, k), *samples = a.rows.samples(k);
    const float weight = cone_weight<float>(k), index = static_cast<float>(k);
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      const float radiance = (sum[i] + lean[i]) / (samples[i] + prior);
      mean[i] += weight * radiance;
      own[i] = cone[i] == index ? radiance : own[i];
    }
  }
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float sampled = cone[i] >= 0.0f ? own[i] - mean[i] : 0.0f;
    excess[i] = known[i] > 0.0f ? sampled : 0.0f;
  }
}

/// Older samples of the pixel's cone fade: keep[i] is what is left of them.
HOLDFAST_INLINE void find_keep(const ConeCorrection& a, const float* cone, float* keep) {
  const int count = a.rows.count;
  const float others = a.most_samples - 1.0f;
  for (int i = 0; i < count; ++i) keep[i] = 1.0f;
  for (int k = 0; k < kCones; ++k) {
    const float index = static_cast<float>(k);
    float* samples = a.rows.samples(k);
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      const float kept = min_of(1.0f, others / max_of(samples[i], 1e-20f));
      const float known = samples[i], before = keep[i];
      keep[i] = cone[i] == index ? kept : before;
      samples[i] = cone[i] == index ? kept * known + 1.0f : known;
    }
  }
}

/// out[i] = what the pixel's cone holds of six channels; 0 without a cone.
HOLDFAST_INLINE void pick(float* const* of, const float* cone, int count, float* out) {
  const float *s0 = of[0], *s1 = of[1], *s2 = of[2], *s3 = of[3], *s4 = of[4], *s5 = of[5];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float k = cone[i], v0 = s0[i], v1 = s1[i], v2 = s2[i], v3 = s3[i], v4 = s4[i], v5 = s5[i];
    const float from_4 = k == 4.0f ? v4 : (k == 5.0f ? v5 : 0.0f);
    const float from_2 = k == 2.0f ? v2 : (k == 3.0f ? v3 : from_4);
    out[i] = k == 0.0f ? v0 : (k == 1.0f ? v1 : from_2);
  }
}

/// Adds a value to the sum of the pixel's cone.
HOLDFAST_INLINE void add_values(const ConeCorrection& a, int colour, const float* cone,
                                const float* keep, const float* value) {
  for (int k = 0; k < kCones; ++k) {
    const float index = static_cast<float>(k);
    float* sum = a.rows.sum(colour, k);
#pragma GCC ivdep
    for (int i = 0; i < a.rows.count; ++i) {
      const float before = sum[i], added = keep[i] * before + value[i];
      sum[i] = cone[i] == index ? added : before;
    }
  }
}

/// Cones of luminance, and one chroma, which is that of all: R, G, B of a unit of luminance.
HOLDFAST_INLINE void correct_luminance(const ConeCorrection& a, const float* cone,
                                       const float* known) {
  const int count = a.rows.count;
  float total[kTapBlock], own[kTapBlock], excess[kTapBlock], keep[kTapBlock], value[kTapBlock];
  add_up(a.rows.of, count, total);
  pick(a.rows.of, cone, count, own);
  find_excess(a, 0, cone, known, total, excess);
  find_keep(a, cone, keep);
  float *r = a.noisy[0], *g = a.noisy[1], *b = a.noisy[2];
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) value[i] = luminance(r[i], g[i], b[i]);
  add_values(a, 0, cone, keep, value);
  float *chroma_r = a.rows.chroma(0), *chroma_b = a.rows.chroma(1);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const bool sampled = cone[i] >= 0.0f;
    const float scale = 1.0f / max_of(total[i], kNoLight);
    const float hue_r = total[i] > kNoLight ? chroma_r[i] * scale : 1.0f;
    const float hue_b = total[i] > kNoLight ? chroma_b[i] * scale : 1.0f;
    const float hue_g = max_of(1.0f - 0.2126f * hue_r - 0.0722f * hue_b, 0.0f) / 0.7152f;
    const float left = total[i] > kNoLight ? 1.0f - (1.0f - keep[i]) * own[i] * scale : 0.0f;
    chroma_r[i] = sampled ? left * chroma_r[i] + r[i] : chroma_r[i];
    chroma_b[i] = sampled ? left * chroma_b[i] + b[i] : chroma_b[i];
    r[i] -= excess[i] * hue_r;
    g[i] -= excess[i] * hue_g;
    b[i] -= excess[i] * hue_b;
  }
}

HOLDFAST_INLINE void correct_colours(const ConeCorrection& a, const float* cone,
                                     const float* known) {
  const int count = a.rows.count;
  float total[kTapBlock], excess[3][kTapBlock], keep[kTapBlock];
  for (int c = 0; c < 3; ++c) {
    add_up(a.rows.of + c * kCones, count, total);
    find_excess(a, c, cone, known, total, excess[c]);
  }
  find_keep(a, cone, keep);
  for (int c = 0; c < 3; ++c) {
    add_values(a, c, cone, keep, a.noisy[c]);
    float *value = a.noisy[c], *off = excess[c];
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) value[i] -= off[i];
  }
}

struct CorrectionArgs {
  const ConeCorrection& block;
  const RestingAxes& axes;
};

HOLDFAST_INLINE void correct_body(const CorrectionArgs& args) {
  const ConeCorrection& a = args.block;
  float cone[kTapBlock], known[kTapBlock];
  find_cones(a, args.axes, cone);
  add_up(a.rows.of + a.rows.colours * kCones, a.rows.count, known);
  if (a.rows.colours == 1)
    correct_luminance(a, cone, known);
  else
    correct_colours(a, cone, known);
}

HOLDFAST_INLINE void divide_body(const ConeRows& a) {
  for (int colour = 0; colour < a.colours; ++colour)
    for (int k = 0; k < kCones; ++k) {
      float* sum = a.sum(colour, k);
      const float* samples = a.samples(k);
#pragma GCC ivdep
      for (int i = 0; i < a.count; ++i)
        sum[i] = samples[i] > 0.0f ? sum[i] / max_of(samples[i], 1e-20f) : 0.0f;
    }
}

HOLDFAST_INLINE void multiply_body(const ConeRows& a) {
  for (int colour = 0; colour < a.colours; ++colour)
    for (int k = 0; k < kCones; ++k) {
      float* sum = a.sum(colour, k);
      const float* samples = a.samples(k);
#pragma GCC ivdep
      for (int i = 0; i < a.count; ++i) sum[i] *= samples[i];
    }
}

HOLDFAST_KERNEL(divide, ConeRows)
HOLDFAST_KERNEL(multiply, ConeRows)
HOLDFAST_KERNEL(recall, ConeRecall)
HOLDFAST_KERNEL(correct, CorrectionArgs)

RestingAxes resting_axes() {
  RestingAxes axes;
  for (int k = 0; k < kCones; ++k) {
    const glm::vec3& axis = kPoleAxes<float>.of[k];
    axes.of[k] = {axis.x, axis.y, axis.z};
  }
  return axes;
}

}  // namespace

void sums_to_means(const ConeRows& rows) noexcept { divide(rows); }
void means_to_sums(const ConeRows& rows) noexcept { multiply(rows); }
void recall_cones(const ConeRecall& block) noexcept { recall(block); }

void correct_by_cones(const ConeCorrection& block) noexcept {
  const RestingAxes axes = resting_axes();
  correct({block, axes});
}

}  // namespace holdfast
