#pragma once

#include <string_view>
#include <vector>

#include "client/measure/image.h"
#include "core/frame/frame.h"
#include "core/frame/guides.h"
#include "core/frame/scene_motion.h"
#include "core/history/surface_history.h"

namespace holdfast::measure {

/// What a pixel may follow to the previous frame.
enum class FollowedVector {
  kSurface,     ///< its surface
  kUnchecked,   ///< its surface's vector, wherever it leads
  kSpecular,    ///< reflections: the virtual image of its sampled hit
  kStochastic,  ///< reflections: a pixel that may reflect to the same hit
  kRelative,    ///< reflections: as far as the virtual image has moved
  kShadow,      ///< shadows: its own blocked sample, else the mean blocker nearby; any surface
  kBorrowed,    ///< shadows: the mean blocker nearby; the same receiver
  kDual,        ///< surfaces that were hidden: what lay beside the occluder
};

/// "surface", "unchecked", "specular", ...
std::string_view vector_name(FollowedVector vector);

/// The vectors that are compared for a component. The first is the fallback of the others.
std::vector<FollowedVector> vectors_of(ComponentKind kind);

/// Two successive frames, followed by the core's own functions with what one sample a pixel says of
/// hits and blockers, as the denoiser sees it.
class VectorTracer {
 public:
  /// Frames of one size with the planes that `trace` needs; `before` lists all objects and lights.
  /// References must outlive the tracer. Throws InputError as Denoiser does for bad cameras.
  VectorTracer(const Frame& before, const Frame& now, const std::vector<Light>& lights);
  VectorTracer(const VectorTracer&) = delete;
  VectorTracer& operator=(const VectorTracer&) = delete;

  /// History taps of every pixel; none where the vector leads nowhere that is valid. `seed` is that
  /// of stochastic vectors. Throws InputError for a missing plane.
  Channels<Taps> trace(FollowedVector vector, Component component, std::uint64_t seed) const;

  /// 1 where the surface was hidden or out of sight: its own vector finds no history.
  Mask hidden() const;

 private:
  Channels<Taps> trace_shadow(FollowedVector vector, std::uint32_t light_id) const;
  Channels<Taps> trace_glossy(FollowedVector vector, std::uint64_t seed) const;
  Channels<Taps> trace_unchecked() const;

  const Frame& frame_;
  const std::vector<Light>& lights_;
  int width_, height_;
  SceneMotion scene_;
  Guides previous_, now_;
  SurfaceHistory surface_;
};

}  // namespace holdfast::measure
