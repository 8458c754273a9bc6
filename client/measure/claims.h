#pragma once

#include <string>
#include <vector>

#include "client/measure/comparison_text.h"
#include "client/measure/report.h"

namespace holdfast::measure {

enum class Metric { kRmse, kSsim };
enum class Relation { kAtMost, kBelow, kAtLeast };
enum class Outcome { kHolds, kFails, kNotRun };

/// One claim about `reliable`: how its error on one layer and mask stands to another recipe's.
struct Claim {
  std::string effect;  ///< "shadows", "glossy", "occlusion", "still scene" or "everywhere"
  std::string scene, layer;
  Region region = Region::kEffect;
  Metric metric = Metric::kRmse;
  std::string against;  ///< a recipe, or kAllOthers: the best of them
  double value = 0;     ///< the metric of `reliable` over that of `against`; NaN if not run
  Relation relation = Relation::kAtMost;
  double bar = 0;  ///< what value must be
  Outcome outcome = Outcome::kNotRun;
  /// It was run, but the references' own noise is not small enough beside these errors.
  bool reference_limited = false;
};

inline constexpr const char* kAllOthers = "all others";
/// The effect of the claims that hold for each scene, component and mask.
inline constexpr const char* kEverywhere = "everywhere";

/// Evaluates every claim that the scenes have something for:
///
///   effect        scenes            component   RMSE of `reliable` over that of others, effect
///   mask shadows       fence, cylinder   visibility  clamp <= 0.84, svgf <= 0.60, asvgf < 1 glossy
///   glossy-floor      glossy      specular <= 0.98, asvgf <= 0.54, clamp <= 0.50 occlusion
///   occluder          indirect    clamp <= 0.98, svgf <= 0.91, traditional <= 0.29
///                 and the SSIM of `reliable` is the highest
///   still scene   static            all         svgf: RMSE <= 1.01, SSIM >= 0.99, whole image
///   everywhere    all               all         spatial, clamp, paper: RMSE <= 1.005,
///                                               SSIM >= 0.995, on either mask
///
/// The bars of shadows, glossy and occlusion follow TRMV's comparisons. A claim
/// whose recipe is missing is kNotRun; where a mask holds no pixel there is no claim. Variants of
/// `reliable` (names that start with "reliable-") are none of the others.
std::vector<Claim> evaluate_claims(const std::vector<ReportScene>& scenes);

}  // namespace holdfast::measure
