#pragma once

#include "core/denoiser/denoiser.h"

namespace holdfast {

/// The planes of a frame must be exactly those of the session, each of its size. Throws InputError
/// naming the first that is missing, unknown or of another size.
void check_frame_planes(const DenoiserConfig& config, const PlaneSet& planes);

}  // namespace holdfast
