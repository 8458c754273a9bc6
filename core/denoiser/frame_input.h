#pragma once

#include <cstdint>

#include "core/frame/guides.h"

namespace holdfast {

/// The one place where values from outside enter the core. What cannot be used is repaired, and
/// each function returns how many values that were.

/// Largest radiance that enters; larger values are repaired to it. Its square is still a float far
/// from overflow when a window of it is summed.
inline constexpr float kLargestRadiance = 1e15f;
/// Largest visibility that enters: a sample's weight beyond that is none.
inline constexpr float kLargestVisibility = 1e6f;

inline constexpr float kShortestNormal = 1e-18f, kLongestNormal = 1e18f;

/// Depth, normals and ids of a frame into `out` (whose view is set by the caller). A depth that is
/// not finite or not positive is no surface: that is how sky is sent, and only NaN counts as
/// repaired. A normal that is not finite or of no length (1e-18..1e18, so that its square is a
/// float) is repaired to face the camera.
std::uint64_t load_depth(const Plane& depth, Guides& out);
std::uint64_t load_normals(const Plane& normal, Guides& out);
void load_ids(const Plane* ids, Channels<std::uint32_t>& out);

/// Roughness, kept within 0..1; NaN becomes 1, since nothing is known to be sharp.
std::uint64_t load_roughness(const Plane& roughness, Guides& out);
/// The client's motion vectors as they are; those that are not finite are no motion vectors.
void load_motion(const Plane& motion, Guides& out);

/// A component's plane into `out`. Negative or non-finite values become 0 (visibility: 1, nothing
/// is known to block), too large ones kLargestRadiance (visibility: 1).
std::uint64_t load_signal(const Plane& plane, Channels<float>& out);

}  // namespace holdfast
