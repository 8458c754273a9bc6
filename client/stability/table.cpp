#include "client/stability/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/stability/world.h"

namespace holdfast::stability {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace

std::vector<Entry> all_entries() {
  std::vector<Entry> all;
  for (const auto& group :
       {scale_entries(), radiance_entries(), surface_entries(), light_entries(), camera_entries(),
        object_entries(), size_entries(), time_entries(), long_entries(), packed_entries()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

Finding measure(const Entry& entry, const std::vector<std::string>& recipes) {
  Finding finding{entry.name, entry.input, entry.expected, entry.limit, {}, {}, true};
  for (const std::string& recipe : recipes) {
    double error = HUGE_VAL;
    try {
      error = entry.error(recipe);
    } catch (const std::exception& thrown) {
      finding.failure = thrown.what();
    }
    if (std::isnan(error)) error = HUGE_VAL;
    finding.errors[recipe] = error;
    finding.passed &= error <= entry.limit.of(recipe);
  }
  return finding;
}

std::vector<Finding> measure_table(const TableOptions& options,
                                   const std::function<void(const std::string&)>& progress) {
  const std::vector<std::string>& recipes =
      options.recipes.empty() ? recipe_names() : options.recipes;
  for (const std::string& recipe : recipes) {
    World world;
    world.recipe = recipe;
    Denoiser denoiser(session_of(world));  // refuses a name that it does not know
  }
  std::vector<Finding> findings;
  for (const Entry& entry : all_entries()) {
    if (entry.cost == Entry::Cost::kLong && !options.with_long) continue;
    if (entry.cost == Entry::Cost::kLarge && !options.with_large) continue;
    progress(entry.name);
    findings.push_back(measure(entry, recipes));
  }
  return findings;
}

bool all_passed(const std::vector<Finding>& findings) {
  return std::all_of(findings.begin(), findings.end(), [](const Finding& f) { return f.passed; });
}

std::string stability_markdown(const std::vector<Finding>& findings) {
  std::string text = "| entry | input | expected | `" + std::string(kPromised) +
                     "` | limit | others | limit | |\n|---|---|---|---|---|---|---|---|\n";
  for (const Finding& f : findings) {
    const auto promised = f.errors.find(kPromised);
    double others = -1;
    for (const auto& [recipe, error] : f.errors)
      if (recipe != kPromised) others = std::max(others, error);
    text += "| " + f.name + " | " + f.input + " | " + f.expected + " | " +
            (promised == f.errors.end() ? "" : number(promised->second)) + " | " +
            number(f.limit.promised) + " | " + (others < 0 ? "" : number(others)) + " | " +
            number(f.limit.others) + " | " + (f.passed ? "pass" : "**fail**") +
            (f.failure.empty() ? "" : ": " + f.failure) + " |\n";
  }
  return text;
}

nlohmann::ordered_json stability_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  for (const Finding& f : findings) {
    nlohmann::ordered_json one{{"name", f.name},
                               {"input", f.input},
                               {"expected", f.expected},
                               {"limit", f.limit.promised},
                               {"limit_others", f.limit.others},
                               {"errors", nlohmann::ordered_json::object()},
                               {"passed", f.passed}};
    for (const auto& [recipe, error] : f.errors) {
      nlohmann::ordered_json& to = one["errors"][recipe];
      if (std::isfinite(error)) to = error;
    }
    if (!f.failure.empty()) one["failure"] = f.failure;
    entries.push_back(std::move(one));
  }
  return {{"passed", all_passed(findings)}, {"entries", std::move(entries)}};
}

}  // namespace holdfast::stability
