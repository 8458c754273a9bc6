#pragma once

#include <optional>

#include "client/measure/comparison_text.h"
#include "client/measure/report.h"

namespace holdfast::measure {

/// Measures the noise of a sequence's reference of frame `frame` by a second reference of it, made
/// with other random numbers: the RMSE between the two over the square root of 2, for each layer
/// that both have. The effect mask is that of the contract: where the first reference has changed
/// since the nearest earlier one. Throws InputError for files that cannot be read.
std::vector<ReferenceNoise> reference_noise(const std::filesystem::path& sequence,
                                            std::int64_t frame, const PlaneSet& second);

/// References are good enough to rank results if two of them differ by less than this part of the
/// best result's error.
inline constexpr double kReferenceShare = 0.1;

struct ReferenceCheck {
  double noise = 0;      ///< RMSE of one reference
  double best_rmse = 0;  ///< the smallest of all results
  bool sufficient = false;
};

/// Holds the noise of a layer's references against the best result. Nothing if either is unknown.
std::optional<ReferenceCheck> check_references(const ReportScene& scene, const std::string& layer,
                                               Region region);

/// The frame that has both a reference and an earlier one, the last of these; the only frame with a
/// reference if there is no other. Throws InputError for a sequence without references.
std::int64_t last_referenced_frame(const std::filesystem::path& sequence);

}  // namespace holdfast::measure
