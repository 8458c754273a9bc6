#pragma once

#include "core/denoiser/denoiser.h"
#include "tests/core/small_world.h"

namespace holdfast::test {

/// The name of a preset.
std::string random_preset(Random& random);

/// A configuration, mostly one that is accepted.
DenoiserConfig random_config(Random& random);

/// A frame for it, mostly one that is accepted. `index` is moved on, mostly.
Frame random_frame(const DenoiserConfig& config, Random& random, std::int64_t& index);

}  // namespace holdfast::test
