#include "core/history/expected_error_kernel.h"

#include <utility>

#include "core/kernels/variants.h"
#include "core/motion/follow_block.h"

namespace holdfast {
namespace {

HOLDFAST_INLINE void read_body(const VisibilityCandidate& a) {
  TapLanes lanes;
  load_lanes(a.taps, a.count, a.before.samples(), lanes);
  float value[kTapBlock], samples[kTapBlock];
  gather_lanes(a.before.data[0], lanes, value);
  gather_lanes(a.before.samples(), lanes, samples);
  const float* noisy = a.noisy;
  float *out = a.value, *difference = a.difference, *out_samples = a.samples;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float there = value[i], here = noisy[i];
    const float taken = lanes.start[i] != kNoStart ? there : here;
    out[i] = taken;
    difference[i] = taken - here;
    out_samples[i] = samples[i];
  }
}

/// The threshold where a shadow moves over its surface by `move` of its penumbra: at rest there is
/// no reason to expect bias, so that only a large difference counts; the faster, the sooner.
HOLDFAST_INLINE float threshold_of(float move, const ExpectedErrorRule& rule) {
  return rule.noise_threshold + rule.slow_threshold * exp_nonpositive(-move / rule.slow_move) +
         rule.rest_threshold * exp_nonpositive(-move / rule.rest_move);
}

/// The threshold of each pixel, by the motion of the shadow over its surface in widths of the
/// penumbra and a pixel: what a visibility may change by in a frame. `past` is 0 where there was
/// another visibility, for what blocks has just appeared; else 1.
HOLDFAST_INLINE void find_thresholds(const VisibilityBlend& a, float* threshold, float* past) {
  const ExpectedErrorRule rule = a.rule;
  if (a.sweep == nullptr) {
    for (int i = 0; i < a.count; ++i) threshold[i] = rule.noise_threshold;
    for (int i = 0; i < a.count; ++i) past[i] = 1.0f;
    return;
  }
  const float *mx = a.shadow_motion[0], *my = a.shadow_motion[1];
  const float *sx = a.surface_motion[0], *sy = a.surface_motion[1];
  const float *sweep = a.sweep, *samples = a.samples[1];
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float slide_px = abs_of(mx[i] - sx[i]) + abs_of(my[i] - sy[i]);
    const float both = sweep[i] * slide_px / max_of(sweep[i] + slide_px, 1e-9f);
    threshold[i] = threshold_of(samples[i] > 0.0f ? both : sweep[i], rule);
    past[i] = sweep[i] < kAppearedSweep ? 1.0f : 0.0f;
  }
}

/// What a candidate promises at one pixel.
struct Estimate {
  float error;       ///< expected squared error, in units in which a sample's is its variance
  float correction;  ///< share of the local mean difference to subtract, 0..1
};

HOLDFAST_INLINE Estimate estimate(float samples, float difference, float variance, float spread,
                                  float threshold, float spatial_samples) {
  const float own = variance / (samples > 0.0f ? samples : 1.0f);
  const float noise = (variance + own) * spread;
  const float bias = max_of(difference * difference - threshold * noise, 0.0f);
  const float share = bias / (bias + noise);
  const float left = bias * square(1.0f - share) + noise * square(share);
  return {own + spatial_samples * left, share};
}

HOLDFAST_INLINE void blend_body(const VisibilityBlend& a) {
  float threshold[kTapBlock], past[kTapBlock];
  find_thresholds(a, threshold, past);
  const float spatial_samples = a.rule.spatial_samples, advantage = a.rule.surface_advantage;
  const float most = a.rule.most_samples;
  const float *noisy = a.noisy, *variance = a.variance, *spread = a.spread;
  const float *value_0 = a.value[0], *value_1 = a.value[1], *samples_0 = a.samples[0],
              *samples_1 = a.samples[1], *bias_0 = a.bias[0], *bias_1 = a.bias[1];
  float *out = a.out, *out_samples = a.out_samples, *chosen = a.chosen, *history = a.history,
        *weight = a.weight;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float n0 = past[i] * samples_0[i], n1 = past[i] * samples_1[i], v = variance[i];
    const float d0 = bias_0[i], d1 = bias_1[i], h0 = value_0[i], h1 = value_1[i];
    const Estimate surface = estimate(n0, d0, v, spread[i], threshold[i], spatial_samples);
    const Estimate shadow = estimate(n1, d1, v, spread[i], threshold[i], spatial_samples);
    const float better = shadow.error < advantage * surface.error ? 1.0f : 0.0f;
    const float wanted = n0 > 0.0f ? better : 1.0f;
    const float second = n1 > 0.0f ? wanted : 0.0f;
    const float n = second > 0.0f ? n1 : n0, d = second > 0.0f ? d1 : d0;
    const float error = second > 0.0f ? shadow.error : surface.error;
    const float correction = second > 0.0f ? shadow.correction : surface.correction;
    const float given = second > 0.0f ? h1 : h0;
    const float own = min_of(v / error, most - 1.0f), k = n > 0.0f ? own : 0.0f;
    const float alpha = 1.0f / (1.0f + k);
    const float behind = square(1.0f - alpha) / max_of(max_of(n, k), 1e-20f);
    const float samples = 1.0f / (square(alpha) + behind);
    // A correction may not leave the range of a visibility: 0..1, or what it was.
    const float corrected = n > 0.0f ? given - correction * d : given;
    const float h = min_of(max_of(corrected, 0.0f), max_of(given, 1.0f));
    out[i] = alpha * noisy[i] + (1.0f - alpha) * h;
    out_samples[i] = min_of(max_of(samples, 1.0f), most);
    chosen[i] = second;
    history[i] = n;
    weight[i] = 1.0f - alpha;
  }
}

HOLDFAST_KERNEL(read, VisibilityCandidate)
HOLDFAST_KERNEL(blend, VisibilityBlend)

}  // namespace

void read_visibility(const VisibilityCandidate& block) noexcept { read(block); }
void blend_visibility(const VisibilityBlend& block) noexcept { blend(block); }

}  // namespace holdfast
