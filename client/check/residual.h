#pragma once

#include <optional>
#include <vector>

#include "client/check/reading.h"

namespace holdfast::check {

/// What an earlier frame shows where a point should have been.
enum class Match {
  kSurface,   ///< the surface of the same object; `difference` says how well the depth fits
  kHidden,    ///< something nearer: the point was hidden
  kNothing,   ///< something farther or other: the point was not there
  kOutside,   ///< outside the image, or behind the camera
  kUnusable,  ///< an edge or uneven ground, where the grid of pixels says nothing
};

struct Sighting {
  Match match = Match::kUnusable;
  glm::dvec2 pixel{0};    ///< where the point should have been in the earlier image
  double difference = 1;  ///< |expected depth / shown depth - 1|, less what curvature explains
};

/// Looks for a point of the world in `before`. The depth shown between four pixels follows from
/// their reciprocal depths, which a plane makes linear in the image. `id`: the object that it
/// belongs to; ignored if there is no plane of ids.
Sighting look_for(const Seen& before, const glm::dvec3& world_point, std::uint32_t id);

/// The normal of the surface that pixel (x, y) shows, from the depth of pixels around it, facing
/// the camera, unit, world axes. Nothing at the edge of an object or of the image.
std::optional<glm::dvec3> normal_from_depth(const Seen& frame, int x, int y);

/// Two readings of the same samples, each with a residual for every sample; negative = no evidence.
struct Comparison {
  std::int64_t samples = 0;  ///< that both readings have
  std::int64_t lost = 0;     ///< that the first has and the second has not
  double given = 0;          ///< median residual of the first
  double other = 0;          ///< and of the second
  double share = 0;          ///< of the samples: the second has less than half the residual
};
Comparison compare_residuals(const std::vector<float>& given, const std::vector<float>& other);

/// Median of what is not negative; 0 for none.
double median_residual(std::vector<float> residuals);

/// Fewer samples say nothing.
inline constexpr std::int64_t kFewSamples = 40;
/// The share of samples that must speak for a mistake.
inline constexpr double kClearShare = 0.6;

/// Whether the second reading fits clearly better: enough samples, at least kClearShare of them,
/// less than half the median residual, and a first residual above `floor`.
inline bool clearly_better(const Comparison& c, double floor) {
  return c.samples >= kFewSamples && c.samples >= c.lost && c.given > floor &&
         c.other < 0.5 * c.given && c.share >= kClearShare;
}

}  // namespace holdfast::check
