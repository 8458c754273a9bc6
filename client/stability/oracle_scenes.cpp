#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/oracle_study.h"
#include "core/frame/plane_size.h"
#include "core/frame/view_geometry.h"
#include "core/kernels/random.h"

namespace holdfast::stability {
namespace {

/// A number in (0, 1) that follows from where and when it is drawn.
float draw(int x, int y, int t, int use) {
  const auto word = [](int v) { return static_cast<std::uint64_t>(static_cast<unsigned>(v)); };
  return uniform_pair(word(x) | word(y) << 16 | word(t) << 32 | word(use) << 48).u;
}

template <class Body>
void for_each_pixel(const Plane& plane, const Body& body) {
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) body(x, y);
}

/// Bends normals and spreads roughness as functions of the place in the world, so that what is
/// followed keeps both.
void texture(Frame& frame) {
  const Plane& depth = frame.planes.at({PlaneKind::kDepth, {}});
  Plane& normal = *frame.planes.find({PlaneKind::kNormal, {}});
  Plane& roughness = *frame.planes.find({PlaneKind::kRoughness, {}});
  const ViewGeometry view(frame.camera, depth.width(), depth.height());
  for_each_pixel(depth, [&](int x, int y) {
    const double d = double{depth.channel(0).at(x, y)};
    if (!std::isfinite(d)) return;
    const glm::dvec3 at = view.origin + view.rays.position(x + 0.5, y + 0.5, d);
    const double bend[3] = {std::sin(2.1 * at.x), std::sin(1.7 * at.y + 1), std::sin(1.9 * at.z)};
    for (int c = 0; c < 3; ++c) normal.channel(c).at(x, y) += 0.15f * static_cast<float>(bend[c]);
    roughness.channel(0).at(x, y) =
        static_cast<float>(0.3 + 0.25 * std::sin(0.8 * at.x + 0.6 * at.z));
  });
}

/// Gradient samples: none for most strata, and any for the others.
void add_gradients(Frame& frame, const DenoiserConfig& config, int t) {
  for (const PlaneId id : config.planes) {
    if (id.kind != PlaneKind::kGradient) continue;
    const PlaneSize size = plane_size(id, config.width, config.height);
    Plane& plane = frame.planes.add(id, size.width, size.height);
    for_each_pixel(plane, [&](int x, int y) {
      const float now = draw(x, y, t, 1 + static_cast<int>(id.component.kind));
      plane.channel(0).at(x, y) = now < 0.3f ? now : 0.0f;
      plane.channel(1).at(x, y) = now < 0.3f ? 0.3f * draw(x, y, t, 9) : 0.0f;
    });
  }
}

/// Motion vectors as a client might send them: of a pixel or so, some not finite.
void add_motion(Frame& frame, int t) {
  const Plane& depth = frame.planes.at({PlaneKind::kDepth, {}});
  Plane& plane = frame.planes.add({PlaneKind::kMotion, {}}, depth.width(), depth.height());
  for_each_pixel(plane, [&](int x, int y) {
    for (int c = 0; c < 2; ++c) plane.channel(c).at(x, y) = 3 * draw(x, y / 4, t, 4 + c) - 1.5f;
    if (draw(x, y, t, 6) < 0.02f)
      plane.channel(0).at(x, y) = std::numeric_limits<float>::quiet_NaN();
  });
}

DenoiserConfig config_of(const World& world, bool with_motion) {
  DenoiserConfig config = session_of(world);
  for (const Component component :
       {Component{ComponentKind::kVisibility, 0}, Component{ComponentKind::kGlossy, 0},
        Component{ComponentKind::kIndirect, 0}})
    config.planes.push_back({PlaneKind::kGradient, component});
  if (with_motion) config.planes.push_back({PlaneKind::kMotion, {}});
  return config;
}

OracleScene scene_of(const std::string& name, const World& world, int frames, bool with_motion) {
  OracleScene scene{name, config_of(world, with_motion), {}};
  for (int t = 0; t < frames; ++t) {
    Frame frame = render(world, t);
    texture(frame);
    add_gradients(frame, scene.config, t);
    if (with_motion) add_motion(frame, t);
    scene.frames.push_back(std::move(frame));
  }
  return scene;
}

}  // namespace

std::vector<OracleScene> oracle_scenes(int width, int height, int frames) {
  World moving;
  moving.width = width;
  moving.height = height;
  moving.camera = [](int t) {
    return glm::rotate(glm::translate(glm::dmat4(1), {0.031 * t, 0.013 * t, -0.02 * t}), 0.004 * t,
                       glm::dvec3(0.3, 1, 0.1));
  };
  moving.box = [](int t) {
    return glm::rotate(glm::translate(glm::dmat4(1), {-0.8 + 0.11 * t, -0.23, -4}), 0.05 * t,
                       glm::dvec3(0.2, 1, 0.4));
  };
  const auto light = moving.light_place;
  moving.light_place = [light](int t) {
    return glm::translate(glm::dmat4(1), {0.04 * t, 0, 0.03 * t}) * light(t);
  };
  World still = moving;
  still.still = true;
  still.spoil = [frames](Frame& frame, int t) {
    if (t < frames - 1) return;  // the light goes off
    Plane& visibility = *frame.planes.find(PlaneId::of_light(PlaneKind::kVisibility, 0));
    Plane& indirect = *frame.planes.find({PlaneKind::kIndirect, {}});
    for_each_pixel(visibility, [&](int x, int y) {
      visibility.channel(0).at(x, y) = 1;
      for (int c = 0; c < 3; ++c) indirect.channel(c).at(x, y) *= 0.3f;
    });
  };
  std::vector<OracleScene> scenes;
  scenes.push_back(scene_of("moving", moving, frames, false));
  scenes.push_back(scene_of("still", still, frames, false));
  scenes.push_back(scene_of("given motion", moving, frames, true));
  return scenes;
}

}  // namespace holdfast::stability
