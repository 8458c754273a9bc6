#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "client/cli/render.h"
#include "client/measure/report.h"

namespace holdfast::cli {

/// Scenes and recipes to try on each other.
struct StudyOptions {
  std::filesystem::path out;
  std::vector<RenderOptions> scenes;  ///< `out` and `quiet` of each are set by the study
  std::vector<std::string> recipes;   ///< any that the core knows
  bool reuse = false;                 ///< keep sequences that are there already
  bool measure_references = false;    ///< render a second reference and measure their noise
  bool flip = true;                   ///< judge by FLIP, too
  bool quiet = false;                 ///< no progress
};

/// One step of a study and how long it took.
struct StudyStep {
  std::string name;
  double seconds = 0;
};

struct StudyResult {
  std::vector<measure::ReportScene> scenes;
  std::vector<StudyStep> steps;  ///< in the order of work
};

/// Renders each scene to OUT/SCENE/sequence, streams it through a server in this process with each
/// recipe to OUT/SCENE/RECIPE, and compares with the references. Throws InputError for an unknown
/// recipe or scene before it starts, and as its steps do.
StudyResult run_study(const StudyOptions& options);

/// The name of a scene's folder: the scene's, or that of its JSON file without the ending.
std::string scene_folder(const std::string& scene);

/// Does `work` and notes how long it took.
template <class Work>
void timed(std::vector<StudyStep>& steps, const std::string& name, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  steps.push_back({name, took.count()});
}

/// A line with the seconds of each step and their sum.
std::string steps_text(const std::vector<StudyStep>& steps);

}  // namespace holdfast::cli
