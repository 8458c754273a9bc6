#include "client/cli/bench.h"

#include <algorithm>
#include <cstdio>

#include <tbb/global_control.h>
#include <tbb/info.h>

#include "client/cli/bench_frames.h"
#include "core/kernels/isa.h"

namespace holdfast::cli {
namespace {

constexpr int kWarmUp = 2;  // frames: the first has no history, the second fills all buffers
constexpr int kReferenceFrames = 2;  // timed frames of the scalar kernels

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What one recipe took.
struct Timing {
  double ms = 0;
  std::vector<StageTime> stages;
  std::string plan;
};

Timing time_recipe(BenchFrames& frames, const BenchOptions& options, const std::string& recipe,
                   int count) {
  DenoiserConfig config = frames.config();
  config.recipe = recipe;
  config.preset = options.preset;
  config.indirect_basis = options.indirect_basis;
  config.half_resolution = options.half_resolution;
  config.history = options.history;
  Denoiser denoiser(config);
  PlaneSet results;
  std::vector<FrameReport> reports;
  for (int step = 0; step < kWarmUp + count; ++step) {
    FrameReport report = denoiser.filter(frames.at(step), results);
    if (step >= kWarmUp) reports.push_back(std::move(report));
  }
  Timing timing{0, reports.front().stages, denoiser.plan_text()};
  const auto over_frames = [&](const auto& value) {
    std::vector<double> values;
    for (const FrameReport& report : reports) values.push_back(value(report));
    return median(values);
  };
  timing.ms = over_frames([](const FrameReport& report) { return report.ms; });
  for (std::size_t k = 0; k < timing.stages.size(); ++k)
    timing.stages[k].ms = over_frames([k](const FrameReport& r) { return r.stages[k].ms; });
  return timing;
}

/// Runs the scalar kernels while it lives.
class ScalarKernels {
 public:
  ScalarKernels() : before_(selected_isa()) { select_isa(Isa::kScalar); }
  ~ScalarKernels() { select_isa(before_); }
  ScalarKernels(const ScalarKernels&) = delete;
  ScalarKernels& operator=(const ScalarKernels&) = delete;

 private:
  Isa before_;
};

}  // namespace

BenchResult run_bench(const BenchOptions& options) {
  BenchResult result;
  result.isa = isa_name(selected_isa());
  BenchFrames frames(options.scene, options.width, options.height);
  const DenoiserConfig& config = frames.config();
  result.width = config.width;
  result.height = config.height;
  result.threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(result.threads));
  const double ns_per_pixel = 1e6 / (static_cast<double>(config.width) * config.height);
  std::vector<std::string> recipes = options.recipes;
  if (recipes.empty()) recipes.push_back(config.recipe);
  for (const std::string& recipe : recipes) {
    const Timing timing = time_recipe(frames, options, recipe, options.frames);
    result.frames.push_back({recipe, options.preset, timing.ms});
    if (result.frames.size() > 1) continue;
    result.plan = timing.plan;
    for (const StageTime& stage : timing.stages)
      result.stages.push_back({stage.stage, stage.ms * ns_per_pixel, stage.bytes_per_pixel, 0});
  }
  if (!options.reference) return result;
  const ScalarKernels scalar;
  const Timing reference =
      time_recipe(frames, options, recipes.front(), std::min(options.frames, kReferenceFrames));
  for (std::size_t k = 0; k < result.stages.size(); ++k)
    result.stages[k].reference_ns_per_pixel = reference.stages[k].ms * ns_per_pixel;
  return result;
}

nlohmann::ordered_json bench_json(const BenchResult& result) {
  nlohmann::ordered_json json = {{"isa", result.isa},
                                 {"threads", result.threads},
                                 {"width", result.width},
                                 {"height", result.height},
                                 {"stages", nlohmann::ordered_json::array()},
                                 {"frames", nlohmann::ordered_json::array()}};
  for (const BenchStage& s : result.stages)
    json["stages"].push_back({{"stage", s.stage},
                              {"ns_per_pixel", s.ns_per_pixel},
                              {"bytes_per_pixel", s.bytes_per_pixel},
                              {"reference_ns_per_pixel", s.reference_ns_per_pixel}});
  for (const BenchFrame& f : result.frames)
    json["frames"].push_back({{"recipe", f.recipe}, {"preset", f.preset}, {"ms", f.ms}});
  return json;
}

std::string bench_text(const BenchResult& result) {
  char line[160];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof line, values...);
    text += line;
  };
  add("%dx%d, %d threads, %s\n", result.width, result.height, result.threads, result.isa.c_str());
  add("%-32s %10s %10s %10s %8s\n", "stage", "ns/pixel", "scalar", "B/pixel", "GB/s");
  for (const BenchStage& s : result.stages)
    add("%-32s %10.3f %10.3f %10.0f %8.1f\n", s.stage.c_str(), s.ns_per_pixel,
        s.reference_ns_per_pixel, s.bytes_per_pixel, s.bytes_per_pixel / s.ns_per_pixel);
  for (const BenchFrame& f : result.frames)
    add("%-32s %10.1f ms a frame (%s)\n", f.recipe.c_str(), f.ms, f.preset.c_str());
  return text;
}

}  // namespace holdfast::cli
