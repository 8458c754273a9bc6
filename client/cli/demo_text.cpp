#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/cli/demo.h"
#include "client/measure/comparison_text.h"

namespace holdfast::cli {
namespace {

using measure::number_text;
using measure::Region;

std::string row(const measure::ReportResult& result, std::size_t layer) {
  char text[64];
  std::snprintf(text, sizeof text, "  %-12s", result.name.c_str());
  std::string line = text;
  for (const Region region : {Region::kImage, Region::kEffect}) {
    const auto& errors = errors_of(result.comparison.layers[layer], region);
    std::snprintf(text, sizeof text, " | %8s %7s %7s %8s", number_text(errors.rmse, 5).c_str(),
                  number_text(errors.ssim, 4).c_str(), number_text(errors.flip, 4).c_str(),
                  number_text(errors.flicker, 5).c_str());
    line += text;
  }
  return line + "\n";
}

}  // namespace

std::string demo_table(const std::vector<measure::ReportScene>& scenes) {
  std::string table;
  for (const measure::ReportScene& scene : scenes) {
    const auto& layers = scene.results.front().comparison.layers;
    for (std::size_t layer = 0; layer < layers.size(); ++layer) {
      table += scene.name + ", " + layers[layer].name +
               "\n               | whole image                       | where the effect moves\n"
               "  recipe       |     RMSE    SSIM    FLIP  flicker |     RMSE    SSIM    FLIP  "
               "flicker\n";
      for (const measure::ReportResult& result : scene.results) table += row(result, layer);
    }
  }
  return table;
}

nlohmann::ordered_json demo_json(const StudyResult& result) {
  nlohmann::ordered_json json;
  for (const measure::ReportScene& scene : result.scenes)
    for (const measure::ReportResult& recipe : scene.results)
      for (const Region region : {Region::kImage, Region::kEffect})
        json["scenes"][scene.name][recipe.name][region_name(region)] =
            comparison_json(recipe.comparison, region);
  for (const StudyStep& step : result.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace holdfast::cli
