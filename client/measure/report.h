#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "client/measure/compare.h"

namespace holdfast::measure {

/// One result of a scene: a recipe, or whatever else was compared.
struct ReportResult {
  std::string name;
  std::filesystem::path dir;  ///< frame.####.exr
  Comparison comparison;
  /// Median time of a frame in the core, ms; NaN if not known.
  double core_ms = std::numeric_limits<double>::quiet_NaN();
};

/// What remains of noise in the references of one layer, as an RMSE of judged values on either mask
/// of one frame; NaN where the mask is empty.
struct ReferenceNoise {
  std::string layer;
  double image = std::numeric_limits<double>::quiet_NaN();
  double effect = std::numeric_limits<double>::quiet_NaN();
};

/// A scene with everything that was compared on it.
struct ReportScene {
  std::string name, caption;
  std::filesystem::path sequence;     ///< with references
  std::vector<ReportResult> results;  ///< at least one; all compared on the same frames
  std::vector<ReferenceNoise> reference_noise = {};  ///< of some layers; empty if not measured
};

/// Time in the core over that of the scene's result "traditional"; NaN if either is not known.
double core_over_traditional(const ReportScene& scene, const ReportResult& result);

/// How a report is written.
struct ReportOptions {
  std::string title;
  std::string top_html = {};           ///< put before the scenes, as it is
  std::filesystem::path png_dir = {};  ///< also write the pictures there; empty = do not
  /// The page shows the files of png_dir instead of holding the pictures itself. For many results,
  /// whose pictures would make a page of 100 MB.
  bool link_pictures = false;
};

/// Writes one HTML page: for each scene pictures side by side with a slider (noisy, each result,
/// reference; of the last judged frame), error maps, a table of errors over the image and over the
/// effect with the best of each column in bold, and the error over the frames. It needs nothing
/// else, unless its pictures are links. Pictures in `png_dir` are SCENE.LAYER.NAME.png and
/// SCENE.LAYER.NAME.error.png. Throws InputError for input that cannot be read, std::runtime_error
/// if a file cannot be written.
void write_report(const std::filesystem::path& file, const std::vector<ReportScene>& scenes,
                  const ReportOptions& options);

}  // namespace holdfast::measure
