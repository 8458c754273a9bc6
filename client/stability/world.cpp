#include "client/stability/world.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/cast.h"

namespace holdfast::stability {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// Reproducible numbers in [0, 1) that do not depend on the standard library (PCG-RXS-M-XS 32).
class Random {
 public:
  Random(std::uint32_t seed, int t)
      : state_((seed * 2654435761u) ^ (static_cast<std::uint32_t>(t) * 747796405u + 2891336453u)) {}
  double next() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return ((word >> 22) ^ word) * 0x1p-32;
  }

 private:
  std::uint32_t state_;
};

/// A direction of cosine density about `normal`; all along it for spread 0, all of it for 1.
glm::dvec3 spread_direction(glm::dvec3 normal, double spread, Random& random) {
  const double z = 1 - 2 * random.next(), phi = 2 * std::numbers::pi * random.next();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const glm::dvec3 sphere(r * std::cos(phi), r * std::sin(phi), z);
  const glm::dvec3 sum = normal + 0.999 * spread * sphere;
  return glm::normalize(sum);
}

/// A rigid transform whose lengths are `metres` each, moved along by `place`.
glm::dmat4 in_world(const World& world, glm::dmat4 matrix) {
  matrix[3] = glm::dvec4(world.metres * glm::dvec3(matrix[3]), 1);
  return world.place * matrix;
}

/// Writes one frame's pixels.
class Painter {
 public:
  Painter(const World& world, int t, std::uint32_t seed, Frame& frame)
      : world_(world),
        camera_(world.camera(t)),
        light_(world.light_place(t)),
        surfaces_(world, world.box(t)),
        to_world_(world.place),
        random_(seed, t),
        planes_(frame.planes) {
    for (const PlaneId id : session_of(world).planes) planes_.add(id, world.width, world.height);
  }

  void paint() {
    for (int y = 0; y < world_.height; ++y)
      for (int x = 0; x < world_.width; ++x) paint(x, y);
  }

 private:
  void set(PlaneId id, int x, int y, glm::dvec3 value) {
    Plane& plane = *planes_.find(id);
    for (int c = 0; c < plane.channels(); ++c)
      plane.channel(c).at(x, y) = static_cast<float>(value[c]);
  }
  void set_id(PlaneId id, int x, int y, std::uint32_t value) {
    planes_.find(id)->ids().at(x, y) = value;
  }
  static PlaneId of_light(PlaneKind kind) { return PlaneId::of_light(kind, 0); }

  void paint(int x, int y) {
    const double half = std::tan(world_.fov / 2);
    const glm::dvec2 ndc = {(x + 0.5) / world_.width * 2 - 1, 1 - (y + 0.5) / world_.height * 2};
    const glm::dvec3 looking(ndc.x * half * world_.width / world_.height, ndc.y * half, -1);
    const glm::dvec3 eye(camera_[3]), ray = glm::normalize(glm::dmat3(camera_) * looking);
    const auto hit = surfaces_.cast(eye, ray);
    set({PlaneKind::kEmission, {}}, x, y, hit ? glm::dvec3(0) : surfaces_.radiance(eye, ray, hit));
    set({PlaneKind::kAlbedo, {}}, x, y, {0.7, 0.6, 0.5});
    set({PlaneKind::kSpecular, {}}, x, y, glm::dvec3(0.2));
    set({PlaneKind::kRoughness, {}}, x, y, glm::dvec3(world_.roughness));
    set({PlaneKind::kDepth, {}}, x, y,
        glm::dvec3(hit ? world_.metres * hit->distance / glm::length(looking) : double{kInf}));
    set(of_light(PlaneKind::kVisibility), x, y, glm::dvec3(1));
    set(of_light(PlaneKind::kBlockerDistance), x, y, glm::dvec3(double{kInf}));
    set({PlaneKind::kGlossyHitDistance, {}}, x, y, glm::dvec3(double{kInf}));
    if (!hit) return;
    set_id({PlaneKind::kObjectId, {}}, x, y, hit->id);
    set({PlaneKind::kNormal, {}}, x, y, glm::dmat3(to_world_) * hit->normal);
    const glm::dvec3 at = eye + hit->distance * ray;
    shadow(x, y, at);
    bounce(x, y, at, hit->normal, ray);
  }

  void shadow(int x, int y, glm::dvec3 at) {
    const double u = random_.next(), v = random_.next();
    set(of_light(PlaneKind::kLightSample), x, y, {u, v, 0});
    const glm::dvec4 point = light_ * light_point<double>(world_.light, u, v);
    const glm::dvec3 way = point.w > 0 ? glm::dvec3(point) - at : glm::dvec3(point);
    if (glm::dot(way, way) == 0) return;
    const auto blocker = surfaces_.cast(at, glm::normalize(way));
    if (!blocker || (point.w > 0 && blocker->distance > glm::length(way) - 1e-6)) return;
    set(of_light(PlaneKind::kVisibility), x, y, glm::dvec3(0));
    set(of_light(PlaneKind::kBlockerDistance), x, y, glm::dvec3(world_.metres * blocker->distance));
    set_id(of_light(PlaneKind::kBlockerId), x, y, blocker->id);
  }

  void bounce(int x, int y, glm::dvec3 at, glm::dvec3 normal, glm::dvec3 ray) {
    const double lobe = double{world_.roughness} * double{world_.roughness};
    const glm::dvec3 mirrored = spread_direction(glm::reflect(ray, normal), lobe, random_);
    if (glm::dot(mirrored, normal) > 0) {
      const auto hit = surfaces_.cast(at, mirrored);
      set({PlaneKind::kGlossyDirection, {}}, x, y, glm::dmat3(to_world_) * mirrored);
      set({PlaneKind::kGlossy, {}}, x, y, surfaces_.radiance(at, mirrored, hit));
      if (hit) {
        set({PlaneKind::kGlossyHitDistance, {}}, x, y, glm::dvec3(world_.metres * hit->distance));
        set_id({PlaneKind::kGlossyHitId, {}}, x, y, hit->id);
      }
    }
    const glm::dvec3 up = spread_direction(normal, 1, random_);
    set({PlaneKind::kIndirectDirection, {}}, x, y, glm::dmat3(to_world_) * up);
    set({PlaneKind::kIndirect, {}}, x, y, surfaces_.radiance(at, up, surfaces_.cast(at, up)));
  }

  const World& world_;
  glm::dmat4 camera_, light_;
  Surfaces surfaces_;
  glm::dmat4 to_world_;
  Random random_;
  PlaneSet& planes_;
};

}  // namespace

World::World() {
  camera = [](int t) { return glm::translate(glm::dmat4(1), {0.03 * t, 0.01 * t, 0}); };
  box = [](int t) { return glm::translate(glm::dmat4(1), {-0.8 + 0.1 * t, -0.2, -4}); };
  light_place = [](int) {
    return glm::rotate(glm::translate(glm::dmat4(1), {0.3, 2, -3.2}), -std::numbers::pi / 2,
                       {1, 0, 0});
  };
}

DenoiserConfig session_of(const World& world) {
  DenoiserConfig config;
  config.width = world.width;
  config.height = world.height;
  config.recipe = world.recipe;
  config.history = world.history;
  config.lights = {world.light};
  config.lights.insert(config.lights.end(), world.more_lights.begin(), world.more_lights.end());
  for (Light& light : config.lights) {
    light.width *= world.metres;
    light.height *= world.metres;
    if (light.shape != LightShape::kDirectional) light.radius *= world.metres;
    light.radiance *= world.radiance;
    if (light.shape == LightShape::kPoint) light.radiance *= world.metres * world.metres;
  }
  for (const PlaneKind kind :
       {PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kObjectId, PlaneKind::kRoughness,
        PlaneKind::kAlbedo, PlaneKind::kSpecular, PlaneKind::kEmission, PlaneKind::kGlossy,
        PlaneKind::kGlossyDirection, PlaneKind::kGlossyHitDistance, PlaneKind::kGlossyHitId,
        PlaneKind::kIndirect, PlaneKind::kIndirectDirection})
    config.planes.push_back({kind, {}});
  for (const PlaneKind kind : {PlaneKind::kVisibility, PlaneKind::kBlockerDistance,
                               PlaneKind::kBlockerId, PlaneKind::kLightSample})
    config.planes.push_back(PlaneId::of_light(kind, 0));
  return config;
}

Frame render(const World& world, int t, std::uint32_t seed) {
  const int now = world.still ? 0 : t;
  Frame frame;
  frame.index = t;
  frame.camera.view_from_world = glm::inverse(in_world(world, world.camera(now)));
  frame.camera.clip_from_view =
      glm::perspective(world.fov, static_cast<double>(world.width) / world.height,
                       world.near * world.metres, world.far * world.metres);
  frame.objects[world.box_id] = in_world(world, world.box(now));
  frame.lights[0] = in_world(world, world.light_place(now));
  // Random numbers differ from frame to frame even where nothing moves.
  Painter(world, now, seed * 7919u + static_cast<std::uint32_t>(t), frame).paint();
  if (world.spoil) world.spoil(frame, t);
  return frame;
}

PlaneSet truth(const World& world, int t, int draws) {
  World clean = world;
  clean.spoil = nullptr;
  PlaneSet mean;
  for (int draw = 0; draw < draws; ++draw) {
    const Frame frame = render(clean, t, 1000u + static_cast<std::uint32_t>(draw));
    for (const PlaneId id : {PlaneId::of_light(PlaneKind::kVisibility, 0),
                             PlaneId{PlaneKind::kGlossy, {}}, PlaneId{PlaneKind::kIndirect, {}}}) {
      Plane& sum = mean.add(id, world.width, world.height);
      for (int c = 0; c < sum.channels(); ++c)
        for (int y = 0; y < world.height; ++y)
          for (int x = 0; x < world.width; ++x)
            sum.channel(c).at(x, y) +=
                frame.planes.at(id).channel(c).at(x, y) / static_cast<float>(draws);
    }
  }
  return mean;
}

}  // namespace holdfast::stability
