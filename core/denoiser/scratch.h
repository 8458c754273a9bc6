#pragma once

#include "core/denoiser/plan.h"
#include "core/history/cone_history.h"
#include "core/history/effect_history.h"
#include "core/history/expected_error.h"
#include "core/history/gradients.h"
#include "core/history/radiance_blend.h"
#include "core/motion/effect_field.h"
#include "core/spatial/signal.h"

namespace holdfast {

// Channels of Scratch::measured and Scratch::means.
inline constexpr int kLuminance = 0;
inline constexpr int kSquare = 1;
inline constexpr int kSampleVariance = kSquare;  // of the means, once they are final
inline constexpr int kField = 2;                 // the channels of a shadow field
inline constexpr int kMeasured = kField + int{kEffectFieldChannels};

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

}  // namespace holdfast
