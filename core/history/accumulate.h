#pragma once

#include "core/history/component_history.h"

namespace holdfast {

/// What is done to history that no longer fits.
enum class Rectification {
  kNone,
  kClamp,          ///< to mean +- gamma sigma of the current 3x3 neighbourhood (Salvi 2016)
  kClampBox,       ///< to least and greatest of the current 3x3 neighbourhood (Karis 2014)
  kClampFallback,  ///< as kClamp, only where the surface vector stood in for the shadow's (TRMV)
};

/// Rule of an exponential mean.
struct AccumulationRule {
  float alpha = 0.1f;  ///< least weight of the current frame, 0..1
  Rectification rectification = Rectification::kNone;
  float clamp_gamma = 1.0f;  ///< in standard deviations; unless kClampBox
};

/// Blends the current frame with its history:
///   C_i = a noisy + (1 - a) C_{i-1},  a = max(alpha, 1 / (N + 1)),  then a' = 1 - trust (1 - a)
/// where trust is that of the shadow vector and N the number of samples behind the history, which
/// levels off at (2 - alpha) / alpha. The shadow vector is taken where it has taps, else the
/// surface vector; what stands in for the surface the other way round, with full trust. Colours are
/// clamped in YCoCg. With gradients, trust is multiplied by 1 - lambda, which makes a' = (1 -
/// lambda) a + lambda (A-SVGF eq. 6).
///   reads noisy, `before` | writes `now`, `signal`, `debug` (may be null) | halo 1 px
void accumulate(const Guides& guides, const Channels<float>& noisy, const HistorySources& sources,
                const AccumulationRule& rule, const ComponentHistory& before, ComponentHistory& now,
                Channels<float>* debug);

/// The same with C in the channels of `signal`, in place of those of `now`.
void accumulate(const Guides& guides, const Channels<float>& noisy, const HistorySources& sources,
                const AccumulationRule& rule, const ComponentHistory& before, ComponentHistory& now,
                Channels<float>& signal, Channels<float>* debug);

}  // namespace holdfast
