#include "client/measure/vector_tracer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "client/measure/vector_meter.h"
#include "client/scenes/builtin.h"
#include "client/scenes/renderer.h"
#include "core/denoiser/denoiser.h"
#include "core/frame/error.h"

namespace holdfast::measure {
namespace {

constexpr int kWidth = 128, kHeight = 72;
constexpr Component kReflection{ComponentKind::kGlossy, 0};

scenes::RenderSettings settings_of(std::uint64_t seed, double speed = 1) {
  scenes::RenderSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.reference_spp = 16;
  settings.seed = seed;
  settings.speed = speed;
  settings.gradients = false;
  return settings;
}

/// A wall near a lamp, seen in a floor that is a perfect mirror, whatever the angle, while the
/// camera moves.
scenes::Scene mirror_scene() {
  scenes::Scene scene;
  scene.components = {false, true, false};
  scene.camera.vertical_fov_deg = 40;
  scene.camera.motion = scenes::Motion(scenes::look_at({0, 1.5, 4}, {0, 0, 0.6}));
  scene.camera.motion.keys.push_back({10, scenes::look_at({1, 1.8, 3.6}, {0.1, 0, 0.6}), false});
  const scenes::Material mirror{.albedo = glm::dvec3(0), .roughness = 0, .specular = glm::dvec3(1)};
  scene.objects = {scenes::still_object(1, "mirror", mirror, {scenes::quad_part(30, 30)}),
                   scenes::still_object(2, "wall", {.albedo = {0.7, 0.5, 0.3}},
                                        {scenes::box_part({40, 40, 0.2}, {0, 20, -2}, 0)})};
  scenes::SceneLight lamp;
  lamp.light = {.id = 0, .shape = LightShape::kPoint};
  lamp.emission = glm::dvec3(30);
  lamp.motion = scenes::Motion(scenes::Transform{.translation = {0.6, 1.2, 0.2}});
  scene.lights = {lamp};
  return scene;
}

ReferenceHalves reference(const scenes::Scene& scene, std::int64_t frame) {
  ReferenceHalves out;
  for (std::size_t h = 0; h < 2; ++h) {
    scenes::Renderer renderer(scene, settings_of(100 + 2 * static_cast<std::uint64_t>(frame) + h));
    out[h] = Plane({PlaneKind::kGlossy, {}}, kWidth, kHeight);
    add_share(out[h], renderer.reference(frame).at({PlaneKind::kGlossy, {}}), 1.0f);
  }
  return out;
}

TEST(VectorTracer, AMirrorIsFollowedByItsVirtualImageToWithinInterpolation) {
  const scenes::Scene scene = mirror_scene();
  scenes::Renderer renderer(scene, settings_of(1));
  const Frame before = renderer.frame(0), now = renderer.frame(1);
  const std::vector<Light> lights = renderer.lights();
  const VectorTracer tracer(before, now, lights);
  std::vector<std::vector<Channels<Taps>>> taps(1);
  for (const FollowedVector vector : vectors_of(ComponentKind::kGlossy))
    taps[0].push_back(tracer.trace(vector, kReflection, 1));
  const Mask surface = surface_mask(now.planes.at({PlaneKind::kDepth, {}}));
  VectorMeter meter(Measure::kTonemap, taps[0].size());
  meter.add({reference(scene, 0), reference(scene, 1), surface, surface, taps});
  const auto& vectors = meter.figures(Region::kImage).vectors;
  EXPECT_GT(vectors[0].rmse_valid, 0.004) << "the reflection moves over the floor";
  for (const std::size_t image : {1, 2, 3})
    EXPECT_LT(vectors[image].rmse_valid, 5e-4) << vector_name(vectors_of(kReflection.kind)[image]);
}

/// Pixel positions of the frame before, brought along taps.
Warped positions(const Channels<Taps>& taps) {
  Plane grid({PlaneKind::kMotion, {}}, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      grid.channel(0).at(x, y) = static_cast<float>(x);
      grid.channel(1).at(x, y) = static_cast<float>(y);
    }
  return warp(grid, taps[0]);
}

/// The motion plane of the denoiser's debug planes for the second of two frames.
Plane denoiser_motion(const Frame& before, const Frame& now, const std::vector<Light>& lights,
                      const std::string& recipe, Component component) {
  DenoiserConfig config;
  config.width = kWidth;
  config.height = kHeight;
  config.recipe = recipe;
  config.lights = lights;
  config.debug_planes = true;
  for (const Plane& plane : before.planes) config.planes.push_back(plane.id());
  Denoiser denoiser(config);
  PlaneSet results;
  denoiser.filter(before, results);
  denoiser.filter(now, results);
  Plane out({PlaneKind::kDebugMotion, component}, kWidth, kHeight);
  add_share(out, results.at(out.id()), 1.0f);
  return out;
}

/// Of pixels with taps: how many lead exactly to where the denoiser's motion does, and how many
/// within reach. Taps of a receiver's edge lead to what is left of four, or to the
/// nearest of nine.
struct Agreement {
  int pixels = 0, exact = 0, near = 0;
};
Agreement agreement(const Channels<Taps>& taps, const Plane& motion) {
  const Warped from = positions(taps);
  Agreement out;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!from.found[static_cast<std::size_t>(y * kWidth + x)]) continue;
      ++out.pixels;
      const float dx = from.image.channel(0).at(x, y) - static_cast<float>(x);
      const float dy = from.image.channel(1).at(x, y) - static_cast<float>(y);
      const float off =
          std::hypot(dx - motion.channel(0).at(x, y), dy - motion.channel(1).at(x, y));
      out.exact += off < 0.01f;
      out.near += off < 2.2f;
    }
  return out;
}

TEST(VectorTracer, ShadowsLeadWhereTheDenoiserFollowsThem) {
  scenes::Renderer renderer(scenes::fence_scene(), settings_of(1, 2));
  const Frame before = renderer.frame(0), now = renderer.frame(1);
  const std::vector<Light> lights = renderer.lights();
  const VectorTracer tracer(before, now, lights);
  const Component visibility{ComponentKind::kVisibility, 0};
  const Agreement literal = agreement(tracer.trace(FollowedVector::kShadow, visibility, 0),
                                      denoiser_motion(before, now, lights, "paper", visibility));
  EXPECT_GT(literal.pixels, kWidth * kHeight / 10);
  EXPECT_GT(literal.exact, 0.95 * literal.pixels);
  EXPECT_EQ(literal.near, literal.pixels);
}

TEST(VectorTracer, ReflectionsLeadWhereTheDenoiserFollowsThem) {
  scenes::Renderer renderer(scenes::roughness_scene(0.1, true), settings_of(1));
  const Frame before = renderer.frame(0), now = renderer.frame(1);
  const std::vector<Light> lights = renderer.lights();
  const VectorTracer tracer(before, now, lights);
  const Agreement specular =
      agreement(tracer.trace(FollowedVector::kSpecular, kReflection, 0),
                denoiser_motion(before, now, lights, "specular", kReflection));
  EXPECT_GT(specular.pixels, kWidth * kHeight / 10);
  EXPECT_GT(specular.exact, 0.95 * specular.pixels);
  EXPECT_EQ(specular.near, specular.pixels);
}

TEST(VectorTracer, DualVectorsServeOnlySurfacesThatWereHidden) {
  scenes::Scene scene = scenes::occluder_scene();
  scene.components = {false, false, true};
  scenes::Renderer renderer(scene, settings_of(1, 2));
  const Frame before = renderer.frame(0), now = renderer.frame(1);
  const std::vector<Light> lights = renderer.lights();
  const VectorTracer tracer(before, now, lights);
  const Component indirect{ComponentKind::kIndirect, 0};
  const Mask hidden = tracer.hidden();
  const Channels<Taps> dual = tracer.trace(FollowedVector::kDual, indirect, 0);
  const Channels<Taps> surface = tracer.trace(FollowedVector::kSurface, indirect, 0);
  int count = 0, served = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool was_hidden = hidden[static_cast<std::size_t>(y * kWidth + x)] != 0;
      EXPECT_FALSE(was_hidden && surface[0].at(x, y).any());
      EXPECT_TRUE(was_hidden || !dual[0].at(x, y).any());
      count += was_hidden;
      served += dual[0].at(x, y).any();
    }
  EXPECT_GT(count, 20);
  EXPECT_GT(served, count / 2);
}

TEST(VectorTracer, NamesThePlaneThatIsMissing) {
  scenes::Renderer renderer(scenes::fence_scene(), settings_of(1));
  const Frame before = renderer.frame(0), now = renderer.frame(1);
  const std::vector<Light> lights = renderer.lights();
  const VectorTracer tracer(before, now, lights);
  EXPECT_THROW(tracer.trace(FollowedVector::kSpecular, kReflection, 0), InputError);
  EXPECT_THROW(tracer.trace(FollowedVector::kShadow, {ComponentKind::kVisibility, 9}, 0),
               InputError);
}

}  // namespace
}  // namespace holdfast::measure
