#pragma once

#include "core/denoiser/plan.h"

namespace holdfast {

/// The debug planes of a component into `results`, from what its filter recorded in the channels
/// of DebugChannel, at the component's resolution.
void write_debug_planes(const Channels<float>& debug, const Plan::Entry& entry, PlaneSet& results);

}  // namespace holdfast
