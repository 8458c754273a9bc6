#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/denoiser/denoiser.h"

namespace holdfast::stability {

/// Ids of the three surfaces of a world, in its default numbering.
inline constexpr std::uint32_t kFloorId = 1, kWallId = 2, kBoxId = 3;

/// A small scene with every plane that a client can send but motion and gradients: a floor at
/// y = -1, a wall at z = -6 that ends at y = 1.5 (sky above), a moving box of edge 1, and a light.
/// All of it is described in units of the scene; `metres` and `place` bring it into the world, so
/// that the same samples can be sent at any scale and place.
struct World {
  int width = 33, height = 17;
  std::string recipe = "reliable";
  std::string history = "f32";  ///< packed ones round at random: another draw where any bit differs
  double metres = 1;            ///< of one unit
  glm::dmat4 place{1.0};        ///< world from scene; rigid
  double fov = 0.9;             ///< vertical, radians
  double near = 0.1, far = 100;  ///< units; any order
  double radiance = 1;           ///< multiplies all light
  float roughness = 0.3f;
  Light light{0, LightShape::kRectangle, 1.2, 0.8, 0.4, glm::dvec3(4)};  ///< sizes in units
  std::vector<Light> more_lights;  ///< without planes of their own
  std::uint32_t floor_id = kFloorId, wall_id = kWallId, box_id = kBoxId;
  bool still = false;  ///< nothing moves: `t` counts as 0 in all motions
  /// Scene from camera, from box (cube -1/2..1/2) and from light at frame `t`; rigid but the box.
  std::function<glm::dmat4(int t)> camera, box, light_place;
  /// Called last with each frame, to put in what no renderer should send.
  std::function<void(Frame&, int t)> spoil;

  World();
};

/// The session that takes the frames of `world`.
DenoiserConfig session_of(const World& world);

/// Frame `t` of the world, at one sample a pixel. What is random follows from (seed, t) alone.
Frame render(const World& world, int t, std::uint32_t seed = 1);

/// The mean of `draws` frames `t` of other seeds: visibility, glossy and indirect only.
PlaneSet truth(const World& world, int t, int draws = 64);

}  // namespace holdfast::stability
