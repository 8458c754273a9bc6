#pragma once

#include <string>
#include <vector>

namespace holdfast::cli {

/// Percentiles of latency over time as an inline SVG: the time is cut into equal spans, each with
/// the median, the 95th percentile and the largest of its values. `at_s` and `latency_ms` go
/// together. Empty without values.
std::string latency_over_time_svg(const std::vector<double>& at_s,
                                  const std::vector<double>& latency_ms);

/// How often each latency came, as an inline SVG of bars that are equally wide up to the 99.5th
/// percentile; what is beyond is in the last bar. Empty without values.
std::string latency_histogram_svg(const std::vector<double>& latency_ms);

}  // namespace holdfast::cli
