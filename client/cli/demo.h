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
  int reference_spp = 1600;       ///< samples per pixel of references
  std::uint64_t seed = 1;
  double speed = 1;  ///< of all animation
  bool flip = true;  ///< judge by FLIP, too
  bool quiet = false;
};

/// One step of the demonstration and how long it took.
struct DemoStep {
  std::string name;
  double seconds = 0;
};

struct DemoResult {
  std::vector<measure::ReportScene> scenes;
  std::vector<DemoStep> steps;  ///< in the order of work
};

/// Renders each scene to OUT/SCENE/sequence, streams it through a server in this process with each
/// recipe to OUT/SCENE/RECIPE, compares with the references, and writes OUT/report.html,
/// OUT/png/*.png and OUT/demo.png, a strip of pictures of the first scene. Throws as its steps do.
DemoResult run_demo(const DemoOptions& options);

/// A table for each scene and layer: a line a recipe, RMSE, SSIM, FLIP and flicker over the image
/// and over the effect.
std::string demo_table(const std::vector<measure::ReportScene>& scenes);

/// A line with the seconds of each step and their sum.
std::string demo_times(const std::vector<DemoStep>& steps);

/// {"scenes":{"fence":{"reliable":{"image":COMPARISON,"effect":COMPARISON}}},
/// "seconds":{"render fence":40}} with COMPARISON as `holdfast compare --json` writes it.
nlohmann::ordered_json demo_json(const DemoResult& result);

}  // namespace holdfast::cli
