#pragma once

#include <span>

#include "core/history/cone_history.h"
#include "core/oracle/frame_view.h"

namespace holdfast::oracle {

/// One sample a pixel, and the direction that it came from: three channels each.
struct DirectedSamples {
  Image direction, radiance;
};

/// history/cone_history.h: incident radiance of every pixel by six cones, from frame to frame.
class Cones {
 public:
  explicit Cones(RadianceBasis basis) : colours_(basis == RadianceBasis::kConesColour ? 3 : 1) {}

  /// Replaces each pixel's samples, one after the other, by x' = x - (L_k - sum_j W_j L_j), and
  /// learns from them. `effect` (may be null) stands in where a surface has no taps.
  void correct(const FrameView& frame, const Past* effect, std::span<DirectedSamples> samples,
               const ConeRule& rule);
  std::size_t bytes() const { return kept_.bytes(); }

 private:
  /// Of one pixel: sums of radiance and samples by cone; of luminance alone, R and B of its sum.
  struct Pixel {
    double sum[3][kCones] = {}, samples[kCones] = {}, chroma[2] = {};
  };
  void take(Pixel& pixel, const Surfaces& now, DirectedSamples& samples, const ConeRule& rule,
            int x, int y) const;
  Pixel recall(const FrameView& frame, const Taps& taps, int x, int y) const;
  void turn(Pixel& pixel, const glm::dvec3& from, const glm::dvec3& to) const;
  void learn(Pixel& pixel, int cone, const glm::dvec3& radiance, const ConeRule& rule) const;
  glm::dvec3 excess(const Pixel& pixel, int cone, const ConeRule& rule) const;
  int channels() const { return colours_ * kCones + kCones + (colours_ == 1 ? 2 : 0); }

  int colours_;
  Image kept_;  ///< channels of Pixel, in its order
};

}  // namespace holdfast::oracle
