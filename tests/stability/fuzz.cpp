#include "tests/stability/fuzz.h"

#include <cmath>
#include <exception>

#include "core/frame/error.h"
#include "tests/stability/fuzz_input.h"

namespace holdfast::test {
namespace {

constexpr int kMostFrames = 6;

std::string text_of(const DenoiserConfig& config) {
  return config.recipe + " " + config.preset + " " + std::to_string(config.width) + "x" +
         std::to_string(config.height);
}

/// What is wrong with the results of a frame that was accepted; empty if nothing is.
std::string problem_of(const DenoiserConfig& config, const FrameReport& report,
                       const PlaneSet& results) {
  const auto expected = result_planes(config);
  if (results.size() != expected.size()) return "planes too many or too few";
  for (const PlaneId id : expected) {
    const Plane* plane = results.find(id);
    if (plane == nullptr) return plane_name(id) + " is missing";
    for (int c = 0; c < plane->channels(); ++c)
      for (int y = 0; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x)
          if (!std::isfinite(plane->channel(c).at(x, y)))
            return plane_name(id) + " is not finite at " + std::to_string(x) + "," +
                   std::to_string(y) + ": " + std::to_string(plane->channel(c).at(x, y));
  }
  if (report.non_finite_out != 0) return "the report counts values that are not finite";
  if (!std::isfinite(report.mean_history_frames) || report.mean_history_frames < 0)
    return "the mean history is " + std::to_string(report.mean_history_frames);
  for (const NoticedChange& change : report.changes)
    if (!(change.share > 0 && change.share <= 1))
      return "the share of a change is " + std::to_string(change.share);
  return {};
}

/// One frame. Throws what is no InputError.
std::string filter_one(Denoiser& denoiser, const Frame& frame, FuzzOutcome& outcome) {
  PlaneSet results;
  FrameReport report;
  try {
    report = denoiser.filter(frame, results);
  } catch (const InputError&) {
    ++outcome.refused;
    return results.size() == 0 ? "" : "a refused frame left results";
  }
  ++outcome.filtered;
  return problem_of(denoiser.config(), report, results);
}

/// To any other; to and from the oracle it is refused.
void change_preset(Denoiser& denoiser, Random& random) {
  try {
    denoiser.set_preset(random_preset(random));
  } catch (const InputError&) {
    return;
  }
}

}  // namespace

FuzzOutcome fuzz_session(std::uint32_t seed) {
  FuzzOutcome outcome;
  Random random(seed);
  const DenoiserConfig config = random_config(random);
  int at = 0;
  try {
    Denoiser denoiser(config);
    outcome.opened = true;
    std::int64_t index = static_cast<std::int64_t>(random.bits()) - 1000000000;
    for (; at < kMostFrames && outcome.problem.empty(); ++at) {
      const Frame frame = random_frame(config, random, index);
      if (random.uniform() < 0.03) denoiser.reset();
      if (random.uniform() < 0.1) change_preset(denoiser, random);
      outcome.problem = filter_one(denoiser, frame, outcome);
    }
  } catch (const InputError& error) {
    if (outcome.opened) outcome.problem = error.what();
  } catch (const std::exception& error) {
    outcome.problem = std::string("it threw: ") + error.what();
  }
  if (!outcome.problem.empty())
    outcome.problem = "seed " + std::to_string(seed) + ", " + text_of(config) + ", frame " +
                      std::to_string(at) + ": " + outcome.problem;
  return outcome;
}

}  // namespace holdfast::test
