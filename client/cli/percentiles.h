#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace holdfast::cli {

/// The smallest value that `fraction` of the values do not exceed (nearest rank); 0 for none.
inline double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// The middle one, of an even number the upper one; there must be one.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// {"p50", "p95", "p99"} of the values.
nlohmann::ordered_json percentiles(const std::vector<double>& values);

}  // namespace holdfast::cli
