#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/measure/vector_meter.h"
#include "client/measure/vector_tracer.h"

namespace holdfast::measure {

/// The vectors of one component in one scene.
struct VectorCase {
  std::string scene;
  Component component;
  std::optional<double> roughness;  ///< of the floor; reflections only
  int pairs = 0;
  RegionFigures image, effect;  ///< vectors in the order of `vectors_of`
};

struct VectorStudy {
  int width = 0, height = 0;  ///< pixels
  int draws = 0;              ///< of one sample a pixel, for each pair
  std::vector<VectorCase> cases;
};

/// The cases' part of what `holdfast study --vectors --json` writes; docs/formats.md section 6
/// describes it. Null stands for a figure over no pixel.
nlohmann::ordered_json vector_json(const VectorStudy& study);

/// Tables of RMSE, one for each component and way to measure: a row a case, a column a vector, the
/// smallest of each row bold.
std::string vector_markdown(const VectorStudy& study);

}  // namespace holdfast::measure
