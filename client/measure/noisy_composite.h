#pragma once

#include "core/frame/frame.h"

namespace holdfast::measure {

/// The picture of a frame before denoising, as the plane kComposite:
///
///   sum over lights(unshadowed * visibility) + specular * glossy + albedo * indirect + emission
///
/// Absent specular and albedo count as 1, other absent planes as 0; sky is emission alone. The
/// frame has depth.
Plane noisy_composite(const Frame& frame);

}  // namespace holdfast::measure
