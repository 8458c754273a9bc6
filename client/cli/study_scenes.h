#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/cli/render.h"

namespace holdfast::cli {

/// What is chosen for all scenes of a study of quality.
struct QualitySettings {
  std::vector<std::string> scenes{"fence", "cylinder", "glossy-floor", "occluder",
                                  "room",  "static",   "cut"};
  std::int64_t frames = 32;
  int width = 480, height = 270;  ///< pixels
  int reference_spp = 0;          ///< samples per pixel of references; 0 = the scene's own choice
  std::uint64_t seed = 1;
  double speed = 1;  ///< of all animation
};

/// How a scene is rendered for a study of quality. References cost most of the time, so:
///
///   fence, cylinder  shadows alone: 1600 samples, for each frame
///   static           2048 samples, rendered once, for each frame
///   cut              256 samples, rendered once between events, for the last two of every 5
///                    frames, so that judging starts at each event's frame, 30, 60 and 90; always
///                    the frames 17..119 at their own speed
///   others           512 (room), 1024 (glossy-floor), 2048 (occluder) samples, for the last two of
///                    every 8 frames
RenderOptions quality_render(const std::string& scene, const QualitySettings& settings);

}  // namespace holdfast::cli
