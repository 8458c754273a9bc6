#pragma once

#include <span>

#include "core/denoiser/plan.h"
#include "core/denoiser/stage_timer.h"
#include "core/history/cone_history.h"
#include "core/history/effect_history.h"
#include "core/history/frame_pair.h"
#include "core/history/glossy_history.h"
#include "core/history/gradients.h"
#include "core/history/sample_count.h"
#include "core/motion/shadow_field.h"
#include "core/spatial/half_grid.h"

namespace holdfast {

/// The histories of a component while it is filtered: that of the frame before, and its own.
struct HistoryRoom {
  ComponentHistory before, now;  ///< `before` has no images of its own where floats are kept
};

/// Images that the components of one resolution need while they are filtered, one after the other.
/// Nothing in here outlives a component's turn. Their memory is lent for a frame; only rooms of
/// floats have their own, since they change places with histories.
struct Scratch {
  Channels<float> noisy;      ///< the sanitised input: 1 or 3
  Channels<float> measured;   ///< luminance, its square, then the shadow field
  Channels<float> means;      ///< local means of `measured`; then [1] is the sample variance
  Channels<float> footprint;  ///< E, F, G of the penumbra's footprint
  EffectHistory effect;       ///< where shadows, reflections, hidden surfaces were
  ActivityMap measured_activity;
  WindowScratch window;
  BlendScratch blend;
  RadianceBlendScratch radiance_blend;
  FilterScratch filter;
  GradientScratch gradients;  ///< samples of the component; only where a component has them
  HistoryRoom visibility, radiance;
  ConeRoom cones;
  Channels<float> debug;  ///< DebugChannel; only where debug planes are asked for

  Scratch() = default;
  /// `grid`: the components that it is for. Without any, there is `noisy` alone: what is filtered
  /// at another resolution comes in here, too.
  Scratch(int width, int height, const Plan& plan, const Plan::Grid& grid, bool debug);
  /// Adds the images that another plan of the same session needs; the others stay as they are.
  void grow(int width, int height, const Plan& plan, const Plan::Grid& grid, bool debug);
  /// Lets go of images that only components of this resolution, or its radiance, or another format
  /// of their histories would need.
  void trim(const Plan& plan, const Plan::Grid& grid) noexcept;
  static void each_image(auto& s, auto&& visit) {
    for (auto* images : {&s.noisy, &s.measured, &s.means, &s.footprint, &s.debug}) visit(*images);
    EffectHistory::each_image(s.effect, visit);
    WindowScratch::each_image(s.window, visit);
    BlendScratch::each_image(s.blend, visit);
    RadianceBlendScratch::each_image(s.radiance_blend, visit);
    FilterScratch::each_image(s.filter, visit);
    GradientScratch::each_image(s.gradients, visit);
    for (auto* room : {&s.visibility, &s.radiance}) {
      visit(room->before.data);
      visit(room->now.data);
    }
    ConeRoom::each_image(s.cones, visit);
  }

 private:
  void grow_rooms(int width, int height, const Plan& plan, const Plan::Grid& grid);
};

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
