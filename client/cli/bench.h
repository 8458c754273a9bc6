#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/kernels/machine_limits.h"

namespace holdfast::cli {

/// What `holdfast bench` runs.
struct BenchOptions {
  std::string scene = "fence";       ///< built-in scene, scene JSON file, or folder of a sequence
  int width = 1920, height = 1080;   ///< pixels; of no effect on a sequence
  std::vector<std::string> recipes;  ///< empty = "reliable"
  std::string preset = "balanced";
  std::string indirect_basis;                ///< empty = the preset's
  std::vector<std::string> half_resolution;  ///< empty = the preset's
  std::string history;                       ///< empty = the preset's
  std::vector<std::string> signals;          ///< kinds of components that are kept; empty = all
  int rest_turns = 0;                        ///< 0 = the preset's
  int frames = 8;           ///< timed frames of each recipe, >= 1, after those of warm-up
  int warm_frames = 2;      ///< >= 2: the first has no history, the second fills all buffers; at
                            ///< rest, a scene takes turns after some 200
  int threads = 0;          ///< that filter; 0 = one for each core
  bool reference = true;    ///< also time the scalar kernels
  bool one_signal = false;  ///< also time OneSignal
  bool limits = false;      ///< also measure what the machine can do
};

/// One stage of the core, a frame, as the mean over kinds of frames of medians.
struct BenchStage {
  std::string stage;
  double ns_per_pixel = 0;            ///< of frames without it, too, as 0
  double bytes_per_pixel = 0;         ///< that its passes read and write, each plane once a pass
  double reference_ns_per_pixel = 0;  ///< with the scalar kernels; 0 = not measured
};

/// One recipe's whole frame inside the core, likewise.
struct BenchFrame {
  std::string recipe, preset;
  double ms = 0;
  double rested = 0;  ///< components that were passed over, a frame
};

/// A frame of one signal of three channels under recipe `svgf` with four levels, by guides alone:
/// what other filters are usually timed with.
struct OneSignal {
  double us_per_pixel = 0;
  double reference_us_per_pixel = 0;  ///< with the scalar kernels; 0 = not measured
};

struct BenchResult {
  std::string isa;
  int threads = 0, width = 0, height = 0;
  std::vector<BenchStage> stages;  ///< of the first recipe
  std::vector<BenchFrame> frames;  ///< of every recipe
  std::string plan;                ///< of the first recipe
  std::optional<OneSignal> one_signal;
  std::optional<MachineLimits> limits;  ///< the better of before and after all else
};

/// Times the core alone: frames are in memory before the first is filtered, and results are
/// dropped. Recipes take turns, frame by frame. Frames that ran the same stages are of one kind, as
/// nearly all are but where components rest: times are the median of each kind, in its share of the
/// frames. On one thread times are processor time, so that
/// other work on the machine counts little; on more they are wall time.
///
/// The reference of a stage is the same stage in the same run on the same number of threads, its
/// kernels compiled for plain scalar code. What is no kernel is the same code in both.
/// Throws InputError for a bad option or scene.
BenchResult run_bench(const BenchOptions& options);

/// The machine-readable form of a result.
nlohmann::ordered_json bench_json(const BenchResult& result);

/// The same for people: a line a stage, then a line a recipe.
std::string bench_text(const BenchResult& result);

}  // namespace holdfast::cli
