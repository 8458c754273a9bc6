#pragma once

#include <vector>

#include "core/denoiser/component_filter.h"
#include "core/denoiser/half_frame.h"

namespace holdfast {

/// What a denoiser keeps of its last frame.
struct KeptParts {
  const Plan& plan;
  const Guides& guides;  ///< of the last frame, full size
  const HalfFrame& half;
  const std::vector<ComponentFilter>& filters;
};

/// Where another one of the same components keeps it. `guides` has the view of that frame, at the
/// size of the new denoiser.
struct TakingParts {
  const Plan& plan;
  Guides& guides;
  HalfFrame& half;
  std::vector<ComponentFilter>& filters;
};

/// Throws InputError if the lights or planes of `config` are not those of `before`.
void check_same_scene(const DenoiserConfig& config, const DenoiserConfig& before);

/// Hands history on to a denoiser of another size, recipe or preset (core/history/resample.h has
/// the rule). Cones start anew: they only take noise out of new samples, whose mean is right
/// without them.
void take_over(const KeptParts& kept, const TakingParts& taking);

}  // namespace holdfast
