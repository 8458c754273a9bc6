#include "client/cli/load.h"
#include "client/cli/percentiles.h"

namespace holdfast::cli {
namespace {

constexpr double kSlowest = 0.5, kFastest = 2000;  // frames a second for each session
constexpr double kPrecision = 1.1;                 // ratio between what holds and what does not

bool holds(const LoadResult& run, double goal_ms) {
  return run.errors.empty() && run.answered > 0 && run.answered == run.submitted &&
         percentile(run.times.latency, 0.95) <= goal_ms;
}

}  // namespace

LoadSearch search_load(LoadOptions options, double goal_ms) {
  LoadSearch search;
  const auto tries = [&](double fps) {
    options.fps = fps;
    search.runs.push_back(run_load(options));
    return holds(search.runs.back(), goal_ms);
  };
  double good = 0, bad = 0;
  for (double fps = 8; bad == 0 || good == 0;) {
    if (tries(fps)) {
      good = fps;
      if (fps >= kFastest) break;
      fps *= 2;
    } else {
      bad = fps;
      if (fps <= kSlowest) break;
      fps /= 2;
    }
  }
  while (good > 0 && bad > good * kPrecision) {
    const double middle = 0.5 * (good + bad);
    (tries(middle) ? good : bad) = middle;
  }
  search.fps = good;
  return search;
}

}  // namespace holdfast::cli
