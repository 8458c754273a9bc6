#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/cli/study.h"

namespace holdfast::cli {

/// What the demonstration does.
struct DemoOptions {
  std::filesystem::path out;
  std::vector<std::string> scenes{"fence", "cylinder"};
  std::vector<std::string> recipes{"spatial", "traditional", "clamp", "svgf", "paper", "reliable"};
  std::int64_t frames = 24;
  int width = 480, height = 270;  ///< pixels
  int reference_spp = 1600;       ///< samples per pixel of references
  std::uint64_t seed = 1;
  double speed = 1;  ///< of all animation
  bool flip = true;  ///< judge by FLIP, too
  bool quiet = false;
};

/// Studies the recipes on the scenes, with a reference for each frame, and writes OUT/report.html,
/// OUT/png/*.png and OUT/demo.png, a strip of pictures of the first scene. Throws as its steps do.
StudyResult run_demo(const DemoOptions& options);

/// A table for each scene and layer: a line a recipe, RMSE, SSIM, FLIP and flicker over the image
/// and over the effect.
std::string demo_table(const std::vector<measure::ReportScene>& scenes);

/// {"scenes":{"fence":{"reliable":{"image":COMPARISON,"effect":COMPARISON}}},
/// "seconds":{"render fence":40}} with COMPARISON as `holdfast compare --json` writes it.
nlohmann::ordered_json demo_json(const StudyResult& result);

}  // namespace holdfast::cli
