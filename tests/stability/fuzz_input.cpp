#include "tests/stability/fuzz_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "core/frame/plane_size.h"

namespace holdfast::test {
namespace {

bool chance(Random& random, double share) { return random.uniform() < share; }

int whole(Random& random, int low, int high) {
  return low + static_cast<int>(random.uniform(0, high - low + 1));
}

/// Any magnitude that a double of our formats is likely to have, of either sign.
double any_magnitude(Random& random, double least = -9, double most = 9) {
  const double size = std::pow(10.0, random.uniform(least, most));
  return chance(random, 0.5) ? size : -size;
}

/// A value that renderers get wrong.
float awkward(Random& random) {
  constexpr float kValues[] = {0.0f,   -0.0f,  1.0f,       -1.0f,      kNaN,     kInf,  -kInf,
                               1e-45f, 1e-39f, 1.2e-38f,   65504.0f,   65520.0f, 1e15f, 3e38f,
                               -3e38f, 1e-20f, 0.9999999f, 1.0000001f, 2.0f,     1e30f};
  return kValues[static_cast<std::size_t>(whole(random, 0, std::size(kValues) - 1))];
}

Light random_light(Random& random, std::uint32_t id) {
  Light light{id, static_cast<LightShape>(whole(random, 0, 4)), 1, 1, 0.5, glm::dvec3(1)};
  const double sizes[] = {0, 1e-9, 0.1, 1, 1e6, 1e12};
  for (double* size : {&light.width, &light.height, &light.radius})
    if (chance(random, 0.4)) *size = sizes[whole(random, 0, 5)];
  if (chance(random, 0.3)) light.radiance = glm::dvec3(chance(random, 0.5) ? 0 : 1e15, 1e-30, 3);
  if (chance(random, 0.02)) light.width = -1;
  if (chance(random, 0.02)) light.radiance.x = std::nan("");
  return light;
}

/// Any matrix that might be sent for an object or a light.
glm::dmat4 random_transform(Random& random) {
  const double kind = random.uniform();
  glm::dmat4 matrix = random_rigid(random, 3, kind < 0.2 ? 1e7 : 3);
  if (kind > 0.6 && kind < 0.7) matrix = glm::scale(matrix, glm::dvec3(any_magnitude(random)));
  if (kind > 0.7 && kind < 0.75) matrix[whole(random, 0, 3)] = glm::dvec4(0);
  if (kind > 0.75 && kind < 0.8) matrix = glm::dmat4(any_magnitude(random, -300, 300));
  if (kind > 0.8 && kind < 0.82) matrix[whole(random, 0, 3)][whole(random, 0, 3)] = HUGE_VAL;
  if (kind > 0.82 && kind < 0.9) matrix[whole(random, 0, 3)][3] = any_magnitude(random);
  return matrix;
}

Camera random_camera(const DenoiserConfig& config, Random& random) {
  Camera camera;
  const double aspect = static_cast<double>(config.width) / config.height;
  camera.view_from_world = glm::inverse(random_rigid(random, 0.3, chance(random, 0.1) ? 1e7 : 1));
  const double fov = chance(random, 0.2) ? random.uniform(0.02, 3.1) : 0.9;
  double near = chance(random, 0.2) ? 1e-3 : 0.1, far = chance(random, 0.2) ? 1e6 : 100;
  if (chance(random, 0.2)) std::swap(near, far);
  camera.clip_from_view = chance(random, 0.2) ? glm::ortho(-aspect, aspect, -1.0, 1.0, near, far)
                                              : glm::perspective(fov, aspect, near, far);
  if (chance(random, 0.1))
    camera.jitter_px = {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
  if (chance(random, 0.02)) camera.jitter_px.x = any_magnitude(random, -300, 300);
  if (chance(random, 0.03)) camera.view_from_world = random_transform(random);
  if (chance(random, 0.03)) camera.clip_from_view = random_transform(random);
  return camera;
}

/// An ordinary value of that kind of plane.
float ordinary(PlaneKind kind, int channel, Random& random) {
  switch (kind) {
    case PlaneKind::kDepth: return random.real(2, 6);
    case PlaneKind::kNormal: return channel == 2 ? 1.0f : random.real(-0.5f, 0.5f);
    case PlaneKind::kVisibility: return chance(random, 0.5) ? 1.0f : 0.0f;
    case PlaneKind::kBlockerDistance:
    case PlaneKind::kGlossyHitDistance: return chance(random, 0.5) ? random.real(0, 3) : kInf;
    case PlaneKind::kGlossyDirection:
    case PlaneKind::kIndirectDirection: return random.real(-1, 1);
    case PlaneKind::kMotion: return random.real(-3, 3);
    default: return random.real();
  }
}

void fill_plane(Plane& plane, Random& random) {
  // A plane is smooth, ordinary noise, ordinary with some that is not, or nothing but that.
  const double wrong = chance(random, 0.5) ? 0 : (chance(random, 0.8) ? 0.1 : 1.0);
  const bool constant = chance(random, 0.2);
  const bool scaled = chance(random, 0.1);
  const auto scale = static_cast<float>(any_magnitude(random, -30, 30));
  for (int c = 0; c < plane.channels(); ++c) {
    const float first = ordinary(plane.id().kind, c, random);
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        if (plane.is_uint()) {
          plane.ids().at(x, y) = chance(random, wrong)
                                     ? random.bits()
                                     : static_cast<std::uint32_t>(whole(random, 0, 4));
          continue;
        }
        float value = constant ? first : ordinary(plane.id().kind, c, random);
        if (scaled) value *= scale;
        plane.channel(c).at(x, y) = chance(random, wrong) ? awkward(random) : value;
      }
  }
}

/// Preset, and in place of its choices any others, now and then one that is refused.
void choose_preset(DenoiserConfig& config, Random& random) {
  config.preset = random_preset(random);
  const auto choose = [&](std::initializer_list<const char*> of) {
    return std::string(of.begin()[whole(random, 0, static_cast<int>(of.size()) - 1)]);
  };
  if (chance(random, 0.3))
    config.indirect_basis = choose({"irradiance", "luminance-cones", "cones", "cubes"});
  if (chance(random, 0.4))
    config.half_resolution = {choose({"indirect", "glossy", "visibility", "none", "all"})};
  if (chance(random, 0.1))
    config.half_resolution = {"indirect", choose({"glossy", "visibility", "indirect"})};
  if (chance(random, 0.3))
    config.kernel_taps = std::array{0, 9, 13, 25}[static_cast<std::size_t>(whole(random, 0, 3))];
  if (chance(random, 0.2)) config.more_levels = whole(random, -3, 1);
}

}  // namespace

// The oracle is slow, and like the others.
std::string random_preset(Random& random) {
  const auto& names = preset_names();
  const std::string& name =
      names[static_cast<std::size_t>(whole(random, 0, static_cast<int>(names.size()) - 1))];
  return name == "reference" && chance(random, 0.7) ? "balanced" : name;
}

DenoiserConfig random_config(Random& random) {
  DenoiserConfig config;
  config.width = whole(random, 1, 24);
  config.height = whole(random, 1, 20);
  const auto& names = chance(random, 0.2) ? ablation_names() : recipe_names();
  config.recipe =
      names[static_cast<std::size_t>(whole(random, 0, static_cast<int>(names.size()) - 1))];
  choose_preset(config, random);
  config.seed = random.bits();
  config.debug_planes = chance(random, 0.3);
  const double present = chance(random, 0.4) ? 1.0 : 0.7;
  const int lights = whole(random, 0, 2);
  for (int id = 0; id < lights; ++id)
    config.lights.push_back(random_light(random, static_cast<std::uint32_t>(id)));
  for (int k = 0; k <= static_cast<int>(PlaneKind::kGradient); ++k) {
    const auto kind = static_cast<PlaneKind>(k);
    const bool needed = kind == PlaneKind::kDepth || kind == PlaneKind::kNormal;
    if (kind == PlaneKind::kGradient || plane_traits(kind).per_light) {
      for (const Light& light : config.lights)
        if (chance(random, kind == PlaneKind::kGradient ? 0.3 : present))
          config.planes.push_back(PlaneId::of_light(kind, light.id));
    } else if (chance(random, needed ? 0.995 : present)) {
      config.planes.push_back({kind, {}});
    }
    if (kind == PlaneKind::kGradient && chance(random, 0.3))
      config.planes.push_back({kind, {ComponentKind::kIndirect, 0}});
  }
  return config;
}

Frame random_frame(const DenoiserConfig& config, Random& random, std::int64_t& index) {
  Frame frame;
  if (!chance(random, 0.03)) index += chance(random, 0.1) ? 1000000000000 : 1;
  frame.index = index;
  frame.cut = chance(random, 0.05);
  frame.camera = random_camera(config, random);
  for (std::uint32_t id = 0; id < 5; ++id)
    if (chance(random, 0.5)) frame.objects[id] = random_transform(random);
  for (const Light& light : config.lights)
    if (chance(random, 0.8)) frame.lights[light.id] = random_transform(random);
  if (chance(random, 0.01)) frame.lights[99] = glm::dmat4(1);
  for (const PlaneId id : config.planes) {
    if (chance(random, 0.002)) continue;
    PlaneSize size = plane_size(id, config.width, config.height);
    if (chance(random, 0.002)) size.width += 1;
    fill_plane(frame.planes.add(id, size.width, size.height), random);
  }
  return frame;
}

}  // namespace holdfast::test
