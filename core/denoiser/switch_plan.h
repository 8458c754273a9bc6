#pragma once

#include <vector>

#include "core/denoiser/component_filter.h"
#include "core/denoiser/half_frame.h"

namespace holdfast {

/// What a denoiser holds that depends on its preset.
struct PlannedParts {
  Plan& plan;
  GuidePair& guides;
  Scratch& scratch;
  SurfaceHistory& surface;
  HalfFrame& half;
  std::vector<ComponentFilter>& filters;
};

/// Makes `parts` follow `next`, a plan of the same session with another preset, between two frames.
/// History comes along:
///   kernel          nothing changes
///   resolution      half: signal, samples and differences become the means over each quad's
///                   surface; full: they are upsampled along planes, normals and ids. Samples are
///                   not counted anew: four pixels that share a value have as many together
///   format          the same values, rounded where they are packed
///   basis, or resolution or format of a component with cones: the cones start anew. They only take
///   noise out
///                   of new samples, whose mean is right without them
/// `has_past`: history is worth keeping. If memory runs out, `parts` are as they were.
void switch_plan(const DenoiserConfig& config, Plan next, bool has_past, const PlannedParts& parts);

}  // namespace holdfast
