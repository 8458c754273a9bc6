#pragma once

#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// history/gradients.h: lambda of each stratum of 3x3 pixels, from a component's gradient plane.
Image antilag_of(const Surfaces& now, const Plane& gradients, int levels, std::uint64_t& repaired);

}  // namespace holdfast::oracle
