#include "client/cli/study_stability.h"

#include <cstdio>

#include "client/cli/json_file.h"
#include "client/stability/oracle_study.h"
#include "client/stability/table.h"

namespace holdfast::cli {

std::string study_stability(const StabilityStudyOptions& options, bool& passed) {
  const auto progress = [&](const std::string& name) {
    if (!options.quiet) std::fprintf(stderr, "%s\n", name.c_str());
  };
  const auto findings = stability::measure_table({.recipes = options.recipes,
                                                  .with_long = options.with_long,
                                                  .with_large = options.with_large},
                                                 progress);
  if (!options.json.empty()) write_json_file(options.json, stability::stability_json(findings));
  passed = stability::all_passed(findings);
  return stability::stability_markdown(findings);
}

std::string study_oracle(const StabilityStudyOptions& options, bool& passed) {
  const auto findings = stability::study_oracle(options.recipes, [&](const std::string& recipe) {
    if (!options.quiet) std::fprintf(stderr, "%s\n", recipe.c_str());
  });
  if (!options.json.empty()) write_json_file(options.json, stability::oracle_json(findings));
  passed = stability::all_within_budget(findings);
  return stability::oracle_markdown(findings);
}

}  // namespace holdfast::cli
