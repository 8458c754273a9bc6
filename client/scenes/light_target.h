#pragma once

#include <array>

#include <glm/glm.hpp>

#include "client/scenes/light_state.h"
#include "client/scenes/rng.h"
#include "client/scenes/surface.h"

namespace holdfast::scenes {

/// Irradiance per unit radiance that a rectangle light sends to a point, without shadows: Lambert's
/// formula over the rectangle clipped to the horizon. 0 behind the rectangle. `normal` is unit.
double rectangle_irradiance(const LightState& light, const glm::dvec3& point,
                            const glm::dvec3& normal);

/// What one light does to one shading point: its unshadowed light, and the density of light samples
/// under which a shadow ray's answer, 0 or 1, *is* the visibility.
///
/// Visibility is defined as
///     V = integral f(u,v) visible(u,v) du dv / integral f(u,v) du dv,
///     f = luminance(BRDF * emission) * cosine * geometry,
/// the ratio of shadowed to unshadowed light, and 1 where the light does not reach the point.
/// `draw` samples with density f / integral f, so the mean of noisy visibilities in {0,1} is V; the
/// reference averages visible(u,v) with weights f over strata. The same f serves both.
///
/// On surfaces without a lobe, a rectangle that sends less than 1e-4 of what a facing surface gets
/// does not reach.
///
/// f is drawn from by rejection. For diffuse surfaces under a rectangle the bound is proven:
///     f <= max over corners of n.(l-s) * height of s over the light's plane / smallest distance^4.
/// Otherwise (other shapes, lobes, or where that bound accepts less than an eighth) a grid of
/// 16 x 16 cells gives the bound 2 f(cell centre) + mean(f)/2, and f is cut there, for noisy
/// samples and references alike; only highlights narrower than a cell are touched. In f, lobes of
/// roughness below 0.2 are widened to that.
class LightTarget {
 public:
  LightTarget(const LightState& light, const Surface& surface);

  /// True if the light reaches the point where nothing blocks.
  bool reaches() const { return total_ > 0.0; }
  /// Direct light without shadows, materials applied, noise-free. Diffuse rectangles: closed form.
  /// Lobes under rectangles: below roughness 0.2 by linearly transformed cosines, 1 % RMSE or less,
  /// where the midpoint rule over the grid would have to widen them (18 % at 0.15, 38 % at 0.05);
  /// from there on by the midpoint rule, below 0.4 %, where transformed cosines leave 0.3 to 13 %.
  /// The rest: midpoint rule, lobes widened as in f.
  const glm::dvec3& unshadowed() const { return unshadowed_; }

  /// True if f is (n.d)+ / |d|^4 up to a factor, d from the surface to the sample.
  bool is_plain_rectangle() const {
    return light_.light.shape == LightShape::kRectangle && !lobe_ && side_ == 1;
  }

  /// A sample (u, v) in [0,1)^2 with density f / integral f. Requires `reaches`.
  glm::dvec2 draw(Rng& rng) const;
  /// f at (u, v), up to a factor, and the sample.
  double weight(const glm::dvec2& uv, LightSample& sample) const;

 private:
  static constexpr int kGrid = 16;

  double density(const LightSample& sample, glm::dvec3* colour) const;
  bool use_proven_bound();
  void use_grid();

  const LightState& light_;
  const Surface& surface_;
  bool lobe_;
  int side_ = 1;
  double total_ = 0.0;                       // sum of all bounds
  std::array<double, kGrid * kGrid> bound_;  // by cell; the first side_^2 are set
  glm::dvec3 unshadowed_{0.0};
};

}  // namespace holdfast::scenes
