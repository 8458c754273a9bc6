#include "client/cli/percentiles.h"

#include <nlohmann/json.hpp>

namespace holdfast::cli {

nlohmann::ordered_json percentiles(const std::vector<double>& values) {
  return {{"p50", percentile(values, 0.50)},
          {"p95", percentile(values, 0.95)},
          {"p99", percentile(values, 0.99)}};
}

}  // namespace holdfast::cli
