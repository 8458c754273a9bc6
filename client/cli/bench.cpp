#include "client/cli/bench.h"

#include <algorithm>
#include <iterator>
#include <map>

#include <tbb/global_control.h>
#include <tbb/info.h>

#include "client/cli/bench_frames.h"
#include "client/cli/percentiles.h"
#include "client/cli/thread_time.h"
#include "core/kernels/isa.h"

namespace holdfast::cli {
namespace {

constexpr int kLeastWarmUp = 2;  // frames: the first has no history, the second fills all buffers
constexpr int kReferenceFrames = 2;  // timed frames of the scalar kernels

/// One configuration at work.
class Runner {
 public:
  Runner(const DenoiserConfig& config, bool one_thread)
      : denoiser_(config), one_thread_(one_thread) {}

  void filter(const Frame& frame, bool timed) {
    const double start = thread_ms();
    FrameReport report = denoiser_.filter(frame, results_);
    if (one_thread_) {  // this thread has done all of it
      report.ms = thread_ms() - start;
      for (StageTime& stage : report.stages) stage.ms = stage.thread_ms;
    }
    if (timed) reports_.push_back(std::move(report));
  }

  double ms() const {
    double sum = 0;
    for (const auto& [stages, reports] : kinds())
      sum += share(reports) * over(reports, [](const FrameReport& report) { return report.ms; });
    return sum;
  }
  /// In the order in which they came first.
  std::vector<StageTime> stages() const {
    std::vector<StageTime> all;
    for (const auto& [names, reports] : kinds())
      for (std::size_t k = 0; k < names.size(); ++k) {
        const StageTime& stage = reports.front()->stages[k];
        auto found = std::find_if(all.begin(), all.end(), [&](const StageTime& other) {
          return other.stage == stage.stage;
        });
        if (found == all.end()) {
          all.push_back({stage.stage, 0, 0});
          found = std::prev(all.end());
        }
        found->ms +=
            share(reports) * over(reports, [k](const FrameReport& r) { return r.stages[k].ms; });
        found->bytes_per_pixel += share(reports) * stage.bytes_per_pixel;
      }
    return all;
  }
  double rested() const {
    double sum = 0;
    for (const FrameReport& report : reports_) sum += static_cast<double>(report.rested.size());
    return sum / static_cast<double>(reports_.size());
  }
  std::string plan() const { return denoiser_.plan_text(); }

 private:
  using Reports = std::vector<const FrameReport*>;

  /// The timed frames by the stages that they ran.
  std::map<std::vector<std::string>, Reports> kinds() const {
    std::map<std::vector<std::string>, Reports> kinds;
    for (const FrameReport& report : reports_) {
      std::vector<std::string> names;
      for (const StageTime& stage : report.stages) names.push_back(stage.stage);
      kinds[names].push_back(&report);
    }
    return kinds;
  }
  double share(const Reports& kind) const {
    return static_cast<double>(kind.size()) / static_cast<double>(reports_.size());
  }
  template <class Value>
  static double over(const Reports& kind, const Value& value) {
    std::vector<double> values;
    for (const FrameReport* report : kind) values.push_back(value(*report));
    return median(std::move(values));
  }

  Denoiser denoiser_;
  bool one_thread_;
  PlaneSet results_;
  std::vector<FrameReport> reports_;
};

/// Filters `count` frames after `warm` others, each by every runner.
void take_turns(BenchFrames& frames, int warm, int count, std::vector<Runner>& runners) {
  for (int step = 0; step < warm + count; ++step)
    for (Runner& runner : runners) runner.filter(frames.at(step), step >= warm);
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

/// The same with the scalar kernels.
Runner scalar_run(BenchFrames& frames, const DenoiserConfig& config, int count, bool one_thread) {
  const ScalarKernels scalar;
  std::vector<Runner> runners;
  runners.emplace_back(config, one_thread);
  take_turns(frames, kLeastWarmUp, std::min(count, kReferenceFrames), runners);
  return std::move(runners.front());
}

DenoiserConfig config_of(const BenchOptions& options, const DenoiserConfig& of_frames,
                         const std::string& recipe) {
  DenoiserConfig config = of_frames;
  config.recipe = recipe;
  config.preset = options.preset;
  config.indirect_basis = options.indirect_basis;
  config.half_resolution = options.half_resolution;
  config.history = options.history;
  config.rest_turns = options.rest_turns;
  return config;
}

/// Times `frames` after all planes but those of one signal have been dropped from them.
OneSignal time_one_signal(BenchFrames& frames, const BenchOptions& options, bool one_thread) {
  frames.keep_one_signal();
  DenoiserConfig config = frames.config();
  config.recipe = "svgf";
  config.half_resolution = {"none"};
  config.more_levels = -1;  // of five
  const double us_per_pixel = 1e3 / (static_cast<double>(config.width) * config.height);
  std::vector<Runner> runners;
  runners.emplace_back(config, one_thread);
  take_turns(frames, kLeastWarmUp, options.frames, runners);
  OneSignal result{runners.front().ms() * us_per_pixel, 0};
  if (options.reference)
    result.reference_us_per_pixel =
        scalar_run(frames, config, options.frames, one_thread).ms() * us_per_pixel;
  return result;
}

}  // namespace

BenchResult run_bench(const BenchOptions& options) {
  BenchResult result;
  if (options.limits) result.limits = measure_machine_limits();
  result.isa = isa_name(selected_isa());
  BenchFrames frames(options.scene, options.width, options.height,
                     options.warm_frames + options.frames);
  if (!options.signals.empty()) frames.keep(options.signals);
  const DenoiserConfig& of_frames = frames.config();
  result.width = of_frames.width;
  result.height = of_frames.height;
  result.threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(result.threads));
  const bool one_thread = result.threads == 1;
  const double ns_per_pixel = 1e6 / (static_cast<double>(of_frames.width) * of_frames.height);
  std::vector<std::string> recipes = options.recipes;
  if (recipes.empty()) recipes.push_back(of_frames.recipe);
  std::vector<Runner> runners;
  for (const std::string& recipe : recipes)
    runners.emplace_back(config_of(options, of_frames, recipe), one_thread);
  take_turns(frames, options.warm_frames, options.frames, runners);
  for (std::size_t k = 0; k < recipes.size(); ++k)
    result.frames.push_back({recipes[k], options.preset, runners[k].ms(), runners[k].rested()});
  result.plan = runners.front().plan();
  for (const StageTime& stage : runners.front().stages())
    result.stages.push_back({stage.stage, stage.ms * ns_per_pixel, stage.bytes_per_pixel, 0});
  runners.clear();
  if (options.reference) {
    const Runner scalar = scalar_run(frames, config_of(options, of_frames, recipes.front()),
                                     options.frames, one_thread);
    const std::vector<StageTime> stages = scalar.stages();
    for (BenchStage& stage : result.stages)
      for (const StageTime& same : stages)
        if (same.stage == stage.stage) stage.reference_ns_per_pixel = same.ms * ns_per_pixel;
  }
  if (options.one_signal) result.one_signal = time_one_signal(frames, options, one_thread);
  if (result.limits) {
    const MachineLimits after = measure_machine_limits();
    result.limits =
        MachineLimits{std::max(result.limits->multiply_adds_per_ns, after.multiply_adds_per_ns),
                      std::max(result.limits->copy_gb_per_s, after.copy_gb_per_s)};
  }
  return result;
}

}  // namespace holdfast::cli
