#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/measure/compare.h"

namespace holdfast::measure {

/// One result of a scene: a recipe, or whatever else was compared.
struct ReportResult {
  std::string name;
  std::filesystem::path dir;  ///< frame.####.exr
  Comparison comparison;
};

/// A scene with everything that was compared on it.
struct ReportScene {
  std::string name, caption;
  std::filesystem::path sequence;     ///< with references
  std::vector<ReportResult> results;  ///< at least one; all compared on the same frames
};

/// Writes one HTML page that needs nothing else: for each scene pictures side by side with a slider
/// (noisy, each result, reference; of the last judged frame), error maps, a table of errors over
/// the image and over the effect with the best of each column in bold, and the error over the
/// frames. With `png_dir`, the pictures are also written there as SCENE.LAYER.NAME.png. Throws
/// InputError for input that cannot be read, std::runtime_error if a file cannot be written.
void write_report(const std::filesystem::path& file, const std::string& title,
                  const std::vector<ReportScene>& scenes,
                  const std::filesystem::path& png_dir = {});

}  // namespace holdfast::measure
