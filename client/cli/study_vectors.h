#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "client/cli/study.h"
#include "client/measure/vector_tables.h"

namespace holdfast::cli {

struct VectorStudyOptions {
  std::filesystem::path out;      ///< folder of the pictures; none if empty
  int width = 240, height = 135;  ///< pixels
  std::uint64_t seed = 1;
  bool quick = false;  ///< fewer roughnesses, frames, draws and samples
  bool quiet = false;  ///< no progress
};

/// Renders successive frames without noise, follows each pixel to the frame before by every motion
/// vector of its effect, and measures how well that frame, so warped, shows the next:
///
///   reflections  moving objects over a floor of roughness 0 to 1, camera at rest and moving
///   shadows      fence and cylinder, at twice their speed
///   hidden       occluder, indirect light of surfaces that were hidden, at twice its speed
///
/// Hits and blockers are those of one sample a pixel, drawn several times. Steps and their seconds
/// are added to `steps`. Throws InputError for a size out of range, std::runtime_error if a picture
/// cannot be written.
measure::VectorStudy study_vectors(const VectorStudyOptions& options,
                                   std::vector<StudyStep>& steps);

}  // namespace holdfast::cli
