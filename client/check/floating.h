#pragma once

#include "client/check/reading.h"

namespace holdfast::check {

/// True for a camera-relative point that cannot be on any surface: it lies clearly nearer than
/// everything that the frame shows at and around its pixel. False outside the image.
bool floats(const Seen& frame, const glm::dvec3& relative_point);

}  // namespace holdfast::check
