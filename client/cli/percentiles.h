#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

namespace holdfast::cli {

/// The smallest value that `fraction` of the values do not exceed (nearest rank); 0 for none.
inline double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// {"p50", "p95", "p99"} of the values.
inline nlohmann::ordered_json percentiles(const std::vector<double>& values) {
  return {{"p50", percentile(values, 0.50)},
          {"p95", percentile(values, 0.95)},
          {"p99", percentile(values, 0.99)}};
}

}  // namespace holdfast::cli
