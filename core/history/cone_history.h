#pragma once

#include <span>

#include "core/history/cone_kernel.h"
#include "core/history/effect_history.h"
#include "core/history/frame_pair.h"
#include "core/history/kept_images.h"
#include "core/history/surface_history.h"
#include "core/spatial/window.h"

namespace holdfast {

/// Constants of ConeHistory. All ours; tuned on occluder and static.
struct ConeRule {
  float most_samples = 8.0f;    ///< that a cone remembers; older ones fade as new ones come
  float prior_samples = 0.03f;  ///< of the mean of all cones, which one without samples leans on
};

/// One sample a pixel: its radiance (R, G, B) and the direction that it came from, world space.
struct ConeSamples {
  const Plane* directions;
  Channels<float>* radiance;
};

/// Images that cones need while a frame is filtered; nothing in them outlives it. Channels in
/// groups that one filter pass takes: sums of radiance by colour and cone, samples by cone; with
/// luminance alone then R and B, weighed like the sum of luminance.
struct ConeRoom {
  Channels<float> kept;  ///< those of the frame before, then of this; empty where floats are kept
  Channels<float> updated;  ///< before they are spread out

  ConeRoom() = default;
  /// `basis`: of cones.
  ConeRoom(int width, int height, RadianceBasis basis, HistoryFormat format,
           Memory memory = Memory::kOwned);
  static void each_image(auto& s, auto&& visit) {
    visit(s.kept);
    visit(s.updated);
  }
};

/// Incident radiance of every pixel by cone, from frame to frame; what it is good for is to take
/// out of a sample what is only due to where it was drawn. A sample of radiance x in cone k, its
/// cones' radiances L known from frames before, becomes
///   x' = x - (L_k - sum_j W_j L_j),   W_j = cone_weight(j)
/// whose mean is that of x whatever L is, since cone k comes up with probability W_k; but it no
/// longer varies with k where L is right. L is a mean over the cone's samples in time (a cone
/// without a new one keeps its own) and, 3x3 pixels a frame, in space. Once means in time and space
/// are taken of x', each holds sum_j W_j L_j in place of the luck of its samples' directions:
/// irradiance by cones, with what cones cannot tell apart left in (a control variate; ours).
class ConeHistory {
 public:
  ConeHistory() = default;
  /// `basis`: of cones.
  ConeHistory(int width, int height, RadianceBasis basis, HistoryFormat format);

  explicit operator bool() const { return kept_.format() != HistoryFormat::kNone; }
  HistoryFormat format() const { return kept_.format(); }
  std::size_t bytes() const { return kept_.bytes(); }

  /// Replaces the samples, one or more a pixel, by x', which may be negative, and learns from them.
  /// A sample whose direction is (0,0,0), not finite or below the surface stays, and teaches
  /// nothing. `surface`, `effect`: where each pixel's radiance
  /// was one frame ago, `effect` where `surface` has no taps; either may be null, and without
  /// `surface` nothing is known.
  /// `key`: of KeptImages::keep.
  ///   reads guides, taps, directions | writes radiance | halo 1 px
  void correct(const FramePair& frames, const SurfaceHistory* surface, const EffectHistory* effect,
               std::span<const ConeSamples> samples, const ConeRule& rule, std::uint64_t key,
               ConeRoom& room, WindowScratch& window);

 private:
  ConeRows rows_at(int x, int y, int count, Channels<float>& images) const;
  void recall(const Guides& previous, const ConeRoom& room, const Taps* taps,
              const float* const (&normal)[3], const ConeRows& rows) const;

  int colours_ = 1;  ///< of a cone: luminance, or R, G, B
  KeptImages kept_;  ///< channels as in ConeRoom; packed, means in place of sums
};

}  // namespace holdfast
