#pragma once

#include <vector>

#include "core/denoiser/denoiser.h"

namespace holdfast::server {

/// What one preset takes in the core, nanoseconds for each pixel of a frame.
struct PresetCost {
  double frame = 0;       ///< guides, surfaces, composite: once a frame
  double visibility = 0;  ///< each light
  double glossy = 0;
  double indirect = 0;
};

/// Of every preset, fastest first.
using CostTable = std::vector<PresetCost>;

/// Adds up the stages of a measured frame of `pixels` pixels with one light, reflections and
/// indirect light.
PresetCost cost_of_stages(const std::vector<StageTime>& stages, double pixels);

/// What a frame of a session should take in each preset of `table` up to the session's own,
/// milliseconds: the sum over what its planes bring, times its pixels.
std::vector<double> expected_ms(const CostTable& table, const DenoiserConfig& session);

}  // namespace holdfast::server
