#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "client/stability/world.h"

namespace holdfast::stability {

/// Frames that most rows filter.
inline constexpr int kFrames = 8;

/// What came out for each frame of a world.
struct Outcome {
  std::vector<PlaneSet> results;
  std::vector<FrameReport> reports;
};

/// Filters frames 0..frames-1 of a world in one session.
Outcome filter_world(const World& world, int frames = kFrames);

/// The largest difference between planes of the same name in two result sets, `b` times its factor,
/// over the largest value of that plane of `b`. Infinite where a value is not finite. Visibility
/// has no factor.
double relative_difference(const PlaneSet& a, const PlaneSet& b, double factor = 1);
/// The largest of them over all frames.
double relative_difference(const Outcome& a, const Outcome& b, double factor = 1);

/// Root of the mean squared difference of two planes of one kind and size.
double rmse(const Plane& a, const Plane& b);

/// RMSE of what the filter leaves over that of its input, against the truth of the last frame: the
/// largest over visibility, glossy and indirect, or of `only` one of them. Below 1 the filter
/// helped. Where the input has no noise, the RMSE itself. Infinite where any frame is not finite.
double noise_left(const World& world, int frames = kFrames, std::optional<PlaneId> only = {});

/// Values of that plane repaired in a frame.
std::uint64_t repaired(const FrameReport& report, PlaneId plane);
/// False if a value of any result is not finite, or a report says so.
bool all_finite(const Outcome& outcome);

}  // namespace holdfast::stability
