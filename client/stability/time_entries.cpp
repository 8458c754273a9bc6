#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"
#include "core/frame/error.h"

namespace holdfast::stability {
namespace {

/// Indices with gaps, up to the last that there is, against 0, 1, 2, ...
double gaps(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  // What is random follows from the index under some recipes: nothing of it is sent here.
  const Outcome ordinary = filter_world(world);
  Denoiser denoiser(session_of(world));
  double worst = 0;
  const std::int64_t last = std::numeric_limits<std::int64_t>::max();
  const std::int64_t indices[kFrames] = {-9000000000, -3, 0, 1, 50, 51, 9000000000, last};
  for (int t = 0; t < kFrames; ++t) {
    Frame frame = render(world, t);
    frame.index = indices[t];
    PlaneSet results;
    const FrameReport report = denoiser.filter(frame, results);
    if (report.history_reset != ordinary.reports[static_cast<std::size_t>(t)].history_reset)
      return HUGE_VAL;
    worst = std::max(worst,
                     relative_difference(results, ordinary.results[static_cast<std::size_t>(t)]));
  }
  return worst;
}

/// Every frame sent twice: refused by name, and without a trace.
double repeats(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  const Outcome ordinary = filter_world(world);
  Denoiser denoiser(session_of(world));
  double worst = 0;
  for (int t = 0; t < kFrames; ++t) {
    PlaneSet results, none;
    denoiser.filter(render(world, t), results);
    worst = std::max(worst,
                     relative_difference(results, ordinary.results[static_cast<std::size_t>(t)]));
    try {
      denoiser.filter(render(world, t, 2), none);
      return HUGE_VAL;
    } catch (const InputError& error) {
      if (error.subject() != "frame index" || none.size() != 0) return HUGE_VAL;
    }
  }
  return worst;
}

}  // namespace

std::vector<Entry> time_entries() {
  return {{"index-gaps",
           "indices from -9e9 to the largest, with gaps",
           "as with 0, 1, 2, ..., relative to each plane's largest value",
           {0, 0.5},
           gaps},
          {"index-repeats", "each frame twice", "the second refused by name, without a trace", 0,
           repeats}};
}

}  // namespace holdfast::stability
