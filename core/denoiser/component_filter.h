#pragma once

#include <span>

#include "core/denoiser/plan.h"
#include "core/denoiser/scratch.h"
#include "core/denoiser/stage_timer.h"
#include "core/history/cone_history.h"
#include "core/history/frame_pair.h"
#include "core/history/glossy_history.h"
#include "core/history/sample_count.h"
#include "core/motion/shadow_field.h"
#include "core/spatial/half_grid.h"

namespace holdfast {

/// The input of one component, besides `Scratch::noisy`.
struct ComponentInput {
  FramePair frames;
  const SurfaceHistory* surface = nullptr;  ///< null: there is no frame before
  const Light* light = nullptr;             ///< of a visibility with blocker planes, else null
  BlockerPlanes blockers = {};
  const Plane* unshadowed = nullptr;  ///< light of a visibility without shadows; null: not known
  StageTimer& timer;                  ///< told of each stage that ends
  GlossyPlanes reflections = {};      ///< of a glossy component that follows them
  FrameKey key = {};
  std::span<const ConeSamples> cone_samples = {};  ///< of a component kept by cones: one a pixel,
                                                   ///< Scratch::noisy, or, with `quads`, four
  const HalfGrid* quads = nullptr;                 ///< what the means of those four are taken over
  bool gradients = false;  ///< Scratch::gradients holds samples of the component
};

/// Filters one component in time and space, and keeps its history.
///   local statistics -> the effect's vectors -> blend with history -> spatial filter
/// but for SVGF's filter, which needs statistics only where history is young, after the blend.
class ComponentFilter {
 public:
  /// For images of that size.
  ComponentFilter(const Plan& plan, const Plan::Entry& entry, int width, int height);

  /// Works by another recipe from the next frame on: that of another preset. `cones` replace what
  /// was kept by cones; null: that goes on.
  void change(Recipe&& recipe, ConeHistory* cones) noexcept;

  /// Filters `scratch.noisy` into `out`. Fills `scratch.debug` if it is there.
  void run(const ComponentInput& input, Scratch& scratch, Plane& out);

  Component component() const { return component_; }
  /// A copy of what the last frame left for the next one; something else in its place.
  ComponentHistory kept() const;
  void keep(ComponentHistory& history) { kept_.keep(history.data, 0); }
  /// The same, to look at, if it is kept as floats; else empty.
  const Channels<float>& kept_floats() const { return kept_.floats(); }
  /// Mean of the samples behind the pixels on surfaces, after the last frame.
  double mean_history_frames() const { return sample_count_.mean(); }
  /// The same over those that have a history.
  double mean_known_frames() const { return sample_count_.mean_of_known(); }
  /// Share of the tiles whose light has changed though nothing moved, in the last frame.
  double changed_share() const { return changed_share_; }
  /// Kept from frame to frame.
  std::size_t history_bytes() const { return kept_.bytes(); }
  std::size_t cone_bytes() const { return cones_.bytes(); }

 private:
  void correct_by_cones(const ComponentInput& input, Scratch& s);
  bool follows_effect(const ComponentInput& input) const;
  bool shadows_at_rest(const ComponentInput& input) const;
  void trace_effect(const ComponentInput& input, const ShadowTracer* tracer, Scratch& s) const;
  void measure(const ComponentInput& input, const ShadowTracer* tracer, Scratch& s) const;
  void measure_young(const ComponentInput& input, Scratch& s) const;
  void measure_luminance(Scratch& s) const;
  void finish_statistics(Scratch& s) const;
  HistoryRoom& room(Scratch& s) const { return channels_ == 1 ? s.visibility : s.radiance; }
  void blend(const ComponentInput& input, bool follows, Scratch& s);
  void filter(const ComponentInput& input, Scratch& s, Plane& out);
  void keep(const ComponentInput& input, HistoryRoom& histories);

  Component component_;
  bool has_footprint_, follows_effect_;
  Recipe recipe_;
  int channels_;
  ConeHistory cones_;  ///< empty unless the plan keeps cones
  HistoryExtras extras_;
  KeptImages kept_;
  SampleCount sample_count_;
  double changed_share_ = 0;
};

}  // namespace holdfast
