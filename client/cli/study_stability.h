#pragma once

#include <string>
#include <vector>

namespace holdfast::cli {

struct StabilityStudyOptions {
  std::vector<std::string> recipes;
  bool with_long = false, with_large = false;
  bool quiet = false;
  std::string json;  ///< file; empty: none
};

/// Measures the table of extremes and returns it as Markdown; `passed` tells whether all rows did.
std::string study_stability(const StabilityStudyOptions& options, bool& passed);

/// Measures the kernels against the oracle and returns its table as Markdown. Of the options,
/// recipes, quiet and json count.
std::string study_oracle(const StabilityStudyOptions& options, bool& passed);

}  // namespace holdfast::cli
