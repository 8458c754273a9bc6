#include "core/history/radiance_blend_kernel.h"

#include <utility>

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kStep = RadianceBlendScratch::kPerCandidate;
constexpr int kSamples = 3;                // of a candidate
constexpr int kSquare = 3;                 // of a difference
constexpr float kRoundingShare2 = 1e-10f;  // of a value squared: that of 1e-5

HOLDFAST_INLINE void read_body(const CandidateBlock& a) {
  TapLanes lanes;
  load_lanes(a.taps, a.count, a.noisy[0], lanes);
  float gathered[kTapBlock];
  float* square_sum = a.scratch.differences[a.k][kSquare].row(a.y) + a.x;
  for (int i = 0; i < a.count; ++i) square_sum[i] = 0.0f;
  for (int c = 0; c < 3; ++c) {
    gather_lanes(a.before.data[c], lanes, gathered);
    const float* current = a.noisy[c].row(a.y) + a.x;
    float* value = a.scratch.candidates[kStep * a.k + c].row(a.y) + a.x;
    float* difference = a.scratch.differences[a.k][c].row(a.y) + a.x;
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float there = gathered[i], here = current[i];
      const float taken = lanes.start[i] != kNoStart ? there : here;
      const float off = taken - here;
      value[i] = taken;
      difference[i] = off;
      square_sum[i] += off * off;
    }
  }
  gather_lanes(a.before.samples(), lanes, gathered);
  float* samples = a.scratch.candidates[kStep * a.k + kSamples].row(a.y) + a.x;
  for (int i = 0; i < a.count; ++i) samples[i] = gathered[i];
}

/// What a candidate promises at each pixel.
struct Promises {
  float samples[kTapBlock];     ///< 0: no candidate
  float error[kTapBlock];       ///< expected squared error
  float variance[kTapBlock];    ///< of one sample
  float correction[kTapBlock];  ///< share of the difference to subtract, 0..1
};

HOLDFAST_INLINE float norm2(float r, float g, float b) { return r * r + g * g + b * b; }

HOLDFAST_INLINE void promise(const RadianceBlendBlock& a, int k, Promises& p) {
  const RadianceBlendScratch& s = a.scratch;
  const float* n = s.candidates[kStep * k + kSamples].row(a.y) + a.x;
  const float *d0 = s.means[kStep * k].row(a.y) + a.x, *d1 = s.means[kStep * k + 1].row(a.y) + a.x,
              *d2 = s.means[kStep * k + 2].row(a.y) + a.x,
              *square_mean = s.means[kStep * k + kSquare].row(a.y) + a.x;
  const float *h0 = s.candidates[kStep * k].row(a.y) + a.x,
              *h1 = s.candidates[kStep * k + 1].row(a.y) + a.x,
              *h2 = s.candidates[kStep * k + 2].row(a.y) + a.x;
  const float *spread = a.spread, *expected = a.expected[k];
  const float spatial_samples = a.rule.spatial_samples, threshold = a.threshold;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float samples = n[i] > 0.0f ? n[i] : 1.0f, square = square_mean[i];
    // The difference also holds the candidate's own noise.
    const float d_norm2 = norm2(d0[i], d1[i], d2[i]);
    const float rounding = kRoundingShare2 * norm2(h0[i], h1[i], h2[i]);
    const float of_difference = max_of(square - d_norm2, 1e-6f * square + rounding + 1e-30f);
    const float variance = of_difference * samples / (samples + 1.0f);
    const float u = of_difference * spread[i];
    const float bias2 = max_of(max_of(d_norm2 - threshold * u, 0.0f), expected[i] * of_difference);
    const float share = bias2 / (bias2 + u);
    const float left = bias2 * (1.0f - share) * (1.0f - share) + u * share * share;
    p.samples[i] = n[i];
    p.error[i] = variance / samples + spatial_samples * left;
    p.variance[i] = variance;
    p.correction[i] = share;
  }
}

HOLDFAST_INLINE void replace(const float* where, const float* with, int count, float* of) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float other = with[i], own = of[i];
    of[i] = where[i] > 0.0f ? other : own;
  }
}

/// Puts the second candidate in place of the first where it promises less than `share` of its
/// error; `chosen` is 1 there, else 0.
HOLDFAST_INLINE void choose(int count, float share, const Promises& second, Promises& first,
                            float* chosen) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float better = second.error[i] < share * first.error[i] ? 1.0f : 0.0f;
    const float wanted = first.samples[i] > 0.0f ? better : 1.0f;
    chosen[i] = second.samples[i] > 0.0f ? wanted : 0.0f;
  }
  replace(chosen, second.samples, count, first.samples);
  replace(chosen, second.error, count, first.error);
  replace(chosen, second.variance, count, first.variance);
  replace(chosen, second.correction, count, first.correction);
}

HOLDFAST_INLINE void blend_body(const RadianceBlendBlock& a) {
  Promises p, second;
  promise(a, 0, p);
  for (int i = 0; i < a.count; ++i) a.chosen[i] = 0.0f;
  if (a.candidates == 2) {
    promise(a, 1, second);
    choose(a.count, a.rule.second_share, second, p, a.chosen);
  }
  const float most = a.rule.most_samples - 1.0f;
  float *samples = a.samples, *weight = a.weight;
  float* out_samples = a.now.samples().row(a.y) + a.x;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float own = min_of(p.variance[i] / p.error[i], most);
    const float counted = p.samples[i] > 0.0f ? own : 0.0f;
    const float alpha = 1.0f / (1.0f + counted);
    samples[i] = p.samples[i];
    weight[i] = 1.0f - alpha;
    out_samples[i] = 1.0f + counted;
  }
  const int last = kStep * (a.candidates - 1);
  for (int c = 0; c < 3; ++c) {
    const float* in = a.noisy[c].row(a.y) + a.x;
    const float* first = a.scratch.candidates[c].row(a.y) + a.x;
    const float* other = a.scratch.candidates[last + c].row(a.y) + a.x;
    const float* first_bias = a.scratch.means[c].row(a.y) + a.x;
    const float* other_bias = a.scratch.means[last + c].row(a.y) + a.x;
    float* out = a.now.data[c].row(a.y) + a.x;
#pragma GCC ivdep
    for (int i = 0; i < a.count; ++i) {
      const float given_first = first[i], given_other = other[i];
      const float bias_first = first_bias[i], bias_other = other_bias[i];
      const float given = a.chosen[i] > 0.0f ? given_other : given_first;
      const float bias = a.chosen[i] > 0.0f ? bias_other : bias_first;
      const float h = max_of(given - p.correction[i] * bias, 0.0f);
      out[i] = (1.0f - weight[i]) * in[i] + weight[i] * h;
    }
  }
}

HOLDFAST_KERNEL(read, CandidateBlock)
HOLDFAST_KERNEL(blend, RadianceBlendBlock)

}  // namespace

void read_candidate(const CandidateBlock& block) noexcept { read(block); }
void blend_candidates(const RadianceBlendBlock& block) noexcept { blend(block); }

}  // namespace holdfast
