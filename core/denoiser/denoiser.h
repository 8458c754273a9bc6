#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/denoiser/scratch_pool.h"
#include "core/frame/frame.h"

namespace holdfast {

/// What is fixed for the life of a denoiser.
struct DenoiserConfig {
  int width = 0;                ///< pixels, 1..kMaxDimension
  int height = 0;               ///< pixels, 1..kMaxDimension
  std::vector<Light> lights;    ///< each id at most once
  std::vector<PlaneId> planes;  ///< exactly what every frame brings; depth and normal at least
  std::string recipe = "reliable";
  std::string preset = "balanced";
  /// Instead of the preset's choice: "irradiance", "luminance-cones" or "cones"; empty = its
  /// choice.
  std::string indirect_basis;
  /// Likewise the components filtered at half resolution: of "indirect", "glossy" and
  /// "visibility" (of all lights), each at most once, or "none" alone; empty = the preset's choice.
  /// A component that the session lacks, or that has gradient samples, is not affected.
  std::vector<std::string> half_resolution;
  /// Likewise how histories are kept: "f16" (signals in 16 bits, statistics in 8, with exponents
  /// common to 64 pixels) or "f32"; empty = the preset's choice. `reference` keeps doubles in any
  /// case, and recipes that keep moments of the luminance (svgf, asvgf) keep floats.
  std::string history;
  int kernel_taps = 0;  ///< likewise, of the a-trous kernel: 9, 13 or 25; 0 = its choice
  int more_levels = 0;  ///< a-trous levels of radiance added to the recipe's, -3..1
  int rest_turns = 0;   ///< likewise, in how many frames a component at rest is filtered once: 1
                        ///< (in all) .. 16; 0 = the preset's choice
  std::uint64_t seed = 0;
  bool debug_planes = false;  ///< also return motion, history and confidence of each component
};

/// One timed stage of a frame.
struct StageTime {
  std::string stage;           ///< "guides", or with its component: "light0.visibility.blend"
  double ms = 0;               ///< wall time
  double bytes_per_pixel = 0;  ///< that its passes read and write, each plane once a pass
  double thread_ms = 0;        ///< processor time of the thread that calls `filter`, which does all
                               ///< of the work where no other thread may join
};

/// Values that were not finite or out of range and were repaired on the way in.
struct RepairCount {
  PlaneId plane;
  std::uint64_t values = 0;
};

/// Share of a component's image in which light changed though nothing moved, so that its history
/// was corrected or left: a light was switched, or a cut was not announced.
struct NoticedChange {
  Component component;
  double share = 0;  ///< of its tiles, above 0 .. 1
};

/// What happened to one frame.
struct FrameReport {
  std::int64_t index = 0;
  std::string preset;  ///< that it was filtered with
  double ms = 0;       ///< wall time inside the core
  std::vector<StageTime> stages;
  bool history_reset = false;          ///< first frame, cut or reset
  std::vector<NoticedChange> changes;  ///< where the recipe looks for them; most frames: none
  std::vector<Component> rested;       ///< passed over: they show the results of the frame before
  double mean_history_frames = 0;      ///< over surface pixels, all components
  std::vector<RepairCount> repaired;   ///< depth, normal, signal and gradient planes with repairs
  std::uint64_t non_finite_out = 0;    ///< always 0; counted, not assumed
};

/// Filters the frames of one session in order. Owns the history, and borrows all else from a pool
/// for as long as it filters a frame; allocates no image per frame after the first, unless the
/// preset changes. Not thread-safe; one instance serves one session, many instances share the
/// worker pool and may share the pool of scratch.
class Denoiser {
 public:
  /// `scratch`: where it borrows; null: a pool of its own. Throws InputError naming what is wrong
  /// with `config`.
  explicit Denoiser(const DenoiserConfig& config, std::shared_ptr<ScratchPool> scratch = {});
  /// Goes on where `before` is, with another size, recipe, preset or any other choice, but the same
  /// lights and planes: indices, transforms and history come along, resampled where the size
  /// differs (core/denoiser/take_over.h). It borrows from the same pool. History starts anew from
  /// or to preset `reference`, and where either recipe keeps none. `before` is as it was; its
  /// preset that was to follow is not taken. Throws InputError naming what is wrong with `config`.
  Denoiser(const DenoiserConfig& config, const Denoiser& before);
  ~Denoiser();
  Denoiser(Denoiser&&) noexcept;
  Denoiser& operator=(Denoiser&&) noexcept;

  /// Filters one frame. `results` receives `composite` and each component's plane (and the debug
  /// planes if asked for), at the session's size. Throws InputError for a frame that breaks a rule
  /// (plane missing, unknown or of the wrong size; index not increasing; unknown light; singular or
  /// non-finite matrix): then neither history nor `results` has changed.
  FrameReport filter(const Frame& frame, PlaneSet& results);

  /// Changes the preset from the next frame on. History comes along, so that the same frames under
  /// the same sequence of presets give the same bits; core/denoiser/switch_plan.h says how. Where
  /// resolution or basis change, that frame allocates images and reports a stage "preset". Throws
  /// InputError for an unknown name and for `reference`, which shares no history with the others;
  /// then nothing has changed.
  void set_preset(const std::string& preset);

  /// Forgets all history; the next frame starts anew. Where objects and lights stand is kept.
  void reset();

  /// As it was made, but for the preset, which is that of the last frame.
  const DenoiserConfig& config() const;
  /// Bytes that `filter` works with: `held_bytes` and `scratch_bytes`.
  std::size_t memory_bytes() const { return held_bytes() + scratch_bytes(); }
  /// Bytes held from frame to frame: `history_bytes`, and where histories are floats, the images
  /// that they change places with: guides, and one history of each number of channels.
  std::size_t held_bytes() const;
  /// Bytes borrowed for as long as a frame is filtered.
  std::size_t scratch_bytes() const;
  /// Bytes that one frame leaves for the next: histories and guides.
  std::size_t history_bytes() const;
  /// The passes and buffers of this configuration, one per line, with the bytes that a pass moves
  /// and a buffer holds for each pixel of the frame.
  std::string plan_text() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Names of the recipes, in the order of the documentation.
const std::vector<std::string>& recipe_names();
/// Whether planes of that kind can change the results of the recipe of that name, so that it is
/// worth sending them. Gradient planes: only for recipes with gradients, never for unknown names.
bool recipe_uses(std::string_view recipe, PlaneKind kind);
/// `reliable` with one part taken away each, accepted wherever a recipe is named: for measurements.
const std::vector<std::string>& ablation_names();
/// Names of the presets, fastest first; `reference` is the last.
const std::vector<std::string>& preset_names();
/// Those that may be chosen by speed and changed between frames: all but `reference`.
const std::vector<std::string>& kernel_preset_names();
/// Result planes of a configuration: the composite, then each component's planes.
std::vector<PlaneId> result_planes(const DenoiserConfig& config);

}  // namespace holdfast
