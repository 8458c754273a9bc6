#include "client/stability/oracle_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

namespace holdfast::stability {
namespace {

constexpr int kWidth = 64, kHeight = 48, kFramesOfScene = 6;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

/// The worst of one stage under one recipe.
struct Worst {
  double rms = 0, largest = 0, share = 0;
};

}  // namespace

std::vector<OracleFinding> study_oracle(
    const std::vector<std::string>& recipes,
    const std::function<void(const std::string& recipe)>& progress) {
  std::vector<OracleFinding> findings;
  const std::vector<OracleScene> scenes = oracle_scenes(kWidth, kHeight, kFramesOfScene);
  for (const std::string& recipe : recipes.empty() ? recipe_names() : recipes) {
    progress(recipe);
    for (const OracleScene& scene : scenes) {
      DenoiserConfig config = scene.config;
      config.recipe = recipe;
      findings.push_back({recipe, scene.name,
                          oracle_errors(filter_frames(config, "balanced", scene.frames),
                                        filter_by_oracle(config, "balanced", scene.frames))});
    }
  }
  return findings;
}

bool all_within_budget(const std::vector<OracleFinding>& findings) {
  return std::all_of(findings.begin(), findings.end(), [](const OracleFinding& finding) {
    return std::all_of(finding.errors.begin(), finding.errors.end(),
                       [](const OracleErrors& errors) { return errors.within_budget(); });
  });
}

nlohmann::ordered_json oracle_json(const std::vector<OracleFinding>& findings) {
  nlohmann::ordered_json json;
  json["passed"] = all_within_budget(findings);
  json["entries"] = nlohmann::ordered_json::array();
  for (const OracleFinding& finding : findings)
    for (const OracleErrors& errors : finding.errors)
      json["entries"].push_back({{"recipe", finding.recipe},
                                 {"scene", finding.scene},
                                 {"plane", plane_name(errors.plane)},
                                 {"rms", errors.rms},
                                 {"largest", errors.largest},
                                 {"tipped", errors.tipped_share},
                                 {"largest_tip", errors.largest_tip},
                                 {"passed", errors.within_budget()}});
  return json;
}

std::string oracle_markdown(const std::vector<OracleFinding>& findings) {
  std::vector<std::string> recipes;
  std::map<std::pair<std::string, std::string>, Worst> worst;  // by recipe and stage
  for (const OracleFinding& finding : findings) {
    if (recipes.empty() || recipes.back() != finding.recipe) recipes.push_back(finding.recipe);
    for (const OracleErrors& errors : finding.errors) {
      Worst& w = worst[{finding.recipe, oracle_budget(errors.plane.kind).stage}];
      w.rms = std::max(w.rms, errors.rms);
      w.largest = std::max(w.largest, errors.largest);
      w.share = std::max(w.share, errors.tipped_share);
    }
  }
  std::string text = "| recipe | stage | RMS | largest | tipped |\n|---|---|---|---|---|\n";
  for (const PlaneKind kind :
       {PlaneKind::kDebugMotion, PlaneKind::kDebugHistory, PlaneKind::kDebugConfidence,
        PlaneKind::kVisibility, PlaneKind::kGlossy, PlaneKind::kComposite}) {
    const OracleBudget& budget = oracle_budget(kind);
    text += std::string("| budget | ") + budget.stage + " | " + number(budget.rms) + " | " +
            number(budget.tipped) + " | " + number(budget.share) + " |\n";
    for (const std::string& recipe : recipes) {
      const Worst& w = worst[{recipe, budget.stage}];
      text += "| `" + recipe + "` | " + budget.stage + " | " + number(w.rms) + " | " +
              number(w.largest) + " | " + number(w.share) + " |\n";
    }
  }
  return text;
}

}  // namespace holdfast::stability
