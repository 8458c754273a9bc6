#include "client/cli/study_text.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "client/measure/claims_text.h"
#include "client/measure/reference_noise.h"

namespace holdfast::cli {
namespace {

using Json = nlohmann::ordered_json;
using measure::Region;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json recipe_json(const measure::ReportScene& scene, const measure::ReportResult& result) {
  return {{"core_ms_p50", number(result.core_ms)},
          {"core_over_traditional", number(core_over_traditional(scene, result))},
          {"image", comparison_json(result.comparison, Region::kImage)},
          {"effect", comparison_json(result.comparison, Region::kEffect)}};
}

Json noise_json(const measure::ReportScene& scene, const std::string& layer, Region region) {
  const auto check = check_references(scene, layer, region);
  if (!check) return nullptr;
  return {{"reference_rmse", check->noise},
          {"best_rmse", check->best_rmse},
          {"sufficient", check->sufficient}};
}

Json references_json(const measure::ReportScene& scene) {
  Json json = Json::object();
  for (const measure::ReferenceNoise& noise : scene.reference_noise)
    json[noise.layer] = {{"image", noise_json(scene, noise.layer, Region::kImage)},
                         {"effect", noise_json(scene, noise.layer, Region::kEffect)}};
  return json;
}

}  // namespace

Json quality_json(const StudyResult& study, const std::vector<measure::Claim>& claims) {
  Json json;
  for (const measure::ReportScene& scene : study.scenes) {
    Json& out = json["scenes"][scene.name];
    out["caption"] = scene.caption;
    out["references"] = references_json(scene);
    for (const measure::ReportResult& result : scene.results)
      out["recipes"][result.name] = recipe_json(scene, result);
  }
  json["claims"] = claims_json(claims);
  for (const StudyStep& step : study.steps) json["seconds"][step.name] = step.seconds;
  return json;
}

}  // namespace holdfast::cli
