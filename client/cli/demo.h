#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "client/measure/report.h"

namespace holdfast::cli {

/// What the demonstration does.
struct DemoOptions {
  std::filesystem::path out;
  std::vector<std::string> scenes{"fence", "cylinder"};
  std::vector<std::string> recipes{"spatial", "traditional", "clamp", "svgf", "paper", "reliable"};
  std::int64_t frames = 24;
  int width = 480, height = 270;  ///< pixels
  int reference_spp = 256;        ///< samples per pixel of references
  std::uint64_t seed = 1;
  double speed = 1;  ///< of all animation
  bool flip = true;  ///< judge by FLIP, too
  bool quiet = false;
};

/// Renders each scene to OUT/SCENE/sequence, streams it through a server in this process with each
/// recipe to OUT/SCENE/RECIPE, compares with the references, and writes OUT/report.html and
/// OUT/png/*.png. Returns what was compared. Throws as its steps do.
std::vector<measure::ReportScene> run_demo(const DemoOptions& options);

/// A table for each scene and layer: a line a recipe, RMSE, SSIM, FLIP and flicker over the image
/// and over the effect.
std::string demo_table(const std::vector<measure::ReportScene>& scenes);

/// {"scenes":{"fence":{"reliable":{"image":COMPARISON,"effect":COMPARISON}}}} with COMPARISON as
/// `holdfast compare --json` writes it.
nlohmann::ordered_json demo_json(const std::vector<measure::ReportScene>& scenes);

}  // namespace holdfast::cli
