#pragma once

#include "core/denoiser/recipe.h"
#include "core/denoiser/stage_timer.h"
#include "core/history/frame_pair.h"

namespace holdfast {

/// Images that the components of a session need while they are filtered, one after the other.
/// Nothing in here outlives a component's turn.
struct Scratch {
  Channels<float> noisy;      ///< the sanitised input: 1 or 3
  Channels<float> measured;   ///< luminance, its square, then the shadow field
  Channels<float> means;      ///< local means of `measured`; then [1] is the sample variance
  Channels<float> footprint;  ///< E, F, G of the penumbra's footprint
  ShadowHistory shadow;
  ActivityMap measured_activity;
  WindowScratch window;
  BlendScratch blend;
  FilterScratch filter;
  Channels<float> debug;  ///< DebugChannel; only where debug planes are asked for

  Scratch() = default;
  Scratch(int width, int height, bool any_radiance, bool any_shadow, bool blend, bool debug);
  std::size_t bytes() const;
};

/// The input of one component, besides `Scratch::noisy`.
struct ComponentInput {
  FramePair frames;
  const SurfaceHistory* surface = nullptr;  ///< null: there is no frame before
  const Light* light = nullptr;             ///< of a visibility with blocker planes, else null
  BlockerPlanes blockers;
  StageTimer& timer;  ///< told of each stage that ends
};

/// Filters one component in time and space, and keeps its history.
///   local statistics -> shadow vectors -> blend with history -> spatial filter
class ComponentFilter {
 public:
  ComponentFilter(Component component, const Recipe& recipe, int width, int height);

  /// Filters `scratch.noisy` into `out`. Fills `scratch.debug` if it is there.
  void run(const ComponentInput& input, Scratch& scratch, Plane& out);

  Component component() const { return component_; }
  /// Mean of the samples behind the pixels on surfaces, after the last frame.
  double mean_history_frames() const { return mean_history_frames_; }
  std::size_t history_bytes() const { return history_[0].data.bytes() + history_[1].data.bytes(); }

 private:
  bool uses_shadow_vectors() const {
    return recipe_.vectors == HistoryVectors::kPaperShadow ||
           recipe_.vectors == HistoryVectors::kCandidates;
  }
  void measure(const ComponentInput& input, const ShadowTracer* tracer, Scratch& s) const;
  void blend(const ComponentInput& input, bool with_shadow, Scratch& s);
  void filter(const ComponentInput& input, bool with_footprint, Scratch& s, Plane& out);
  void count_history(const Guides& now);

  Component component_;
  Recipe recipe_;
  int channels_;
  ComponentHistory history_[2];
  int now_ = 0;  ///< index of the history that the current frame writes
  std::vector<double> row_samples_, row_pixels_;
  double mean_history_frames_ = 0;
};

}  // namespace holdfast
