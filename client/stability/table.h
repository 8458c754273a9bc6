#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/stability/entry.h"

namespace holdfast::stability {

/// What a row came to.
struct Finding {
  std::string name, input, expected;
  Limits limit;
  std::map<std::string, double> errors;  ///< by recipe; infinite where a result is not finite
  std::string failure;                   ///< what was thrown; empty where nothing was
  bool passed = false;
};

struct TableOptions {
  std::vector<std::string> recipes;  ///< none: all
  bool with_long = false;            ///< rows of many frames
  bool with_large = false;           ///< rows of large images
};

/// All rows, in the order of the table.
std::vector<Entry> all_entries();

/// Measures one row under each of the recipes.
Finding measure(const Entry& entry, const std::vector<std::string>& recipes);

/// Measures the rows that the options ask for; `progress` is called with the name of each before.
/// Throws InputError for an unknown recipe.
std::vector<Finding> measure_table(const TableOptions& options,
                                   const std::function<void(const std::string&)>& progress);

bool all_passed(const std::vector<Finding>& findings);
/// One row each: the error under the promised recipe, the largest under the others. Failures in
/// bold.
std::string stability_markdown(const std::vector<Finding>& findings);
/// {"passed", "entries": [{"name", "input", "expected", "limit", "limit_others", "errors": {recipe:
/// error}, "passed"}]}; an error that is not finite is null; "failure" where something was thrown.
nlohmann::ordered_json stability_json(const std::vector<Finding>& findings);

}  // namespace holdfast::stability
