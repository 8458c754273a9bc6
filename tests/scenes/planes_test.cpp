// Planes of a noisy frame against the conventions and against analytic values.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "client/scenes/glossy.h"
#include "client/scenes/rng.h"
#include "client/scenes/sampling.h"
#include "core/frame/conventions.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast::scenes {
namespace {

/// World position of a pixel's surface from depth and camera alone, as a user of the planes has it.
glm::dvec3 unproject(const Frame& frame, int x, int y) {
  const auto depth = frame.planes.at({PlaneKind::kDepth, {}}).channel(0);
  const glm::dvec2 ndc =
      ndc_from_pixel(glm::dvec2(x + 0.5, y + 0.5), double(depth.width), double(depth.height));
  const glm::dmat4 view_from_clip = glm::inverse(frame.camera.clip_from_view);
  glm::dvec4 p = view_from_clip * glm::dvec4(ndc, 0.5, 1.0);
  p /= p.w;
  const glm::dvec3 in_view = glm::dvec3(p) * (static_cast<double>(depth.at(x, y)) / -p.z);
  return glm::dvec3(glm::inverse(frame.camera.view_from_world) * glm::dvec4(in_view, 1.0));
}

Scene tilted_camera_scene() {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.camera.motion = Motion(look_at({1.5, 2.0, 3.0}, {0.2, 0.1, 0.0}));
  return scene;
}

TEST(Planes, DepthPutsEachFloorPixelOnTheFloor) {
  Renderer renderer(tilted_camera_scene(), small_settings());
  const Frame frame = renderer.frame(0);
  const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
  int floor = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (ids.at(x, y) != 7) continue;
      ++floor;
      const glm::dvec3 p = unproject(frame, x, y);
      EXPECT_NEAR(p.y, 0.0, 2e-5);
      const glm::dvec4 clip =
          frame.camera.clip_from_view * frame.camera.view_from_world * glm::dvec4(p, 1.0);
      const glm::dvec2 pixel = pixel_from_clip(clip, 40.0, 30.0);
      EXPECT_NEAR(pixel.x, x + 0.5, 1e-3);
      EXPECT_NEAR(pixel.y, y + 0.5, 1e-3);
      EXPECT_EQ(colour_at(frame.planes, PlaneKind::kNormal, x, y), glm::dvec3(0, 1, 0));
    }
  }
  EXPECT_GT(floor, 300);
}

TEST(Planes, ImageIsNotMirrored) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.objects[1].motion.keys[0].transform.translation = {0.8, 0.0, -0.8};  // right and far
  StillView still(scene);
  const PlaneSet planes = render_noisy(still.view, 1);
  const auto ids = planes.at({PlaneKind::kObjectId, {}}).ids();
  double x_mean = 0, y_mean = 0;
  int count = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      if (ids.at(x, y) == 9) x_mean += x, y_mean += y, ++count;
  ASSERT_GT(count, 5);
  EXPECT_GT(x_mean / count, 22.0);
  EXPECT_LT(y_mean / count, 12.0);
}

TEST(Planes, NormalsAreUnitAndFaceTheCamera) {
  for (const BuiltinScene& scene : builtin_scenes()) {
    Renderer renderer(scene.make(), small_settings(64, 36));
    const Frame frame = renderer.frame(0);
    const glm::dvec3 eye(glm::inverse(frame.camera.view_from_world)[3]);
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (!is_surface(frame.planes.at({PlaneKind::kDepth, {}}).channel(0).at(x, y))) continue;
        const glm::dvec3 n = colour_at(frame.planes, PlaneKind::kNormal, x, y);
        EXPECT_NEAR(glm::length(n), 1.0, 1e-5);
        EXPECT_GT(glm::dot(n, eye - unproject(frame, x, y)), -1e-3) << scene.name;
      }
    }
  }
}

TEST(Planes, BlockersLieOnTheBox) {
  Renderer renderer(tilted_camera_scene(), small_settings());
  const Frame frame = renderer.frame(3);
  const auto distance = frame.planes.at(of_light(PlaneKind::kBlockerDistance)).channel(0);
  const auto blocker = frame.planes.at(of_light(PlaneKind::kBlockerId)).ids();
  const auto visible = frame.planes.at(of_light(PlaneKind::kVisibility)).channel(0);
  const Plane& sample = frame.planes.at(of_light(PlaneKind::kLightSample));
  const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
  const glm::dmat4 world_from_light = renderer.scene().lights[0].motion.at(0).matrix();
  int blocked = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(visible.at(x, y) == 1.0f, std::isinf(distance.at(x, y)));
      if (ids.at(x, y) != 7 || visible.at(x, y) == 1.0f) continue;
      ++blocked;
      EXPECT_EQ(blocker.at(x, y), 9u);
      const glm::dvec3 s = unproject(frame, x, y);
      const glm::dvec3 l(world_from_light * light_point(rectangle_light(),
                                                        double(sample.channel(0).at(x, y)),
                                                        double(sample.channel(1).at(x, y))));
      const glm::dvec3 b = s + glm::normalize(l - s) * double(distance.at(x, y));
      // Distance from the surface of the box, 0.7 x 0.4 x 0.5 about (0, 0.5, 0).
      const glm::dvec3 q = glm::abs(b - glm::dvec3(0, 0.5, 0)) - glm::dvec3(0.35, 0.2, 0.25);
      EXPECT_NEAR(std::max({q.x, q.y, q.z}), 0.0, 1e-3);
    }
  }
  EXPECT_GT(blocked, 20);
}

TEST(Planes, MirrorShowsWhatTheReflectedRayHits) {
  const Material mirror{.albedo = glm::dvec3(0.0), .roughness = 0.0, .specular = glm::dvec3(1.0)};
  Renderer renderer(floor_and_box(rectangle_light(), {0.8, 2.2, -1.0}, mirror), small_settings());
  const Frame frame = renderer.frame(0);
  const glm::dvec3 eye(0.0, 3.0, 4.0);
  const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
  const auto hit = frame.planes.at({PlaneKind::kGlossyHitId, {}}).ids();
  const auto distance = frame.planes.at({PlaneKind::kGlossyHitDistance, {}}).channel(0);
  int box = 0, sky = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (ids.at(x, y) != 7) continue;
      const glm::dvec3 s = unproject(frame, x, y);
      const glm::dvec3 v = glm::normalize(s - eye);
      const glm::dvec3 d = colour_at(frame.planes, PlaneKind::kGlossyDirection, x, y);
      EXPECT_LT(glm::distance(d, glm::reflect(v, glm::dvec3(0, 1, 0))), 2e-3);
      if (hit.at(x, y) == 9) {
        ++box;
        const glm::dvec3 h = s + d * double(distance.at(x, y));
        const glm::dvec3 q = glm::abs(h - glm::dvec3(0, 0.5, 0)) - glm::dvec3(0.35, 0.2, 0.25);
        EXPECT_NEAR(std::max({q.x, q.y, q.z}), 0.0, 2e-3);
      } else {
        ++sky;
        EXPECT_EQ(hit.at(x, y), 0u);
        EXPECT_TRUE(std::isinf(distance.at(x, y)));
      }
    }
  }
  EXPECT_GT(box, 5);
  EXPECT_GT(sky, 100);
}

TEST(Planes, ConstantSkyGivesItsRadianceAsIndirectLight) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.objects.pop_back();
  scene.lights.clear();
  scene.sky = {{0.5, 1.0, 2.0}, {0.5, 1.0, 2.0}};
  StillView still(scene);
  const PlaneSet noisy = render_noisy(still.view, 1), reference = render_reference(still.view, 16);
  const glm::dvec3 expected(0.5, 1.0, 2.0);
  EXPECT_LT(glm::distance(colour_at(noisy, PlaneKind::kIndirect, 20, 15), expected), 1e-6);
  EXPECT_LT(glm::distance(colour_at(reference, PlaneKind::kIndirect, 20, 15), expected), 1e-6);
  EXPECT_LT(glm::distance(colour_at(reference, PlaneKind::kComposite, 20, 15), 0.6 * expected),
            1e-6);
}

TEST(Planes, MeansOfGlossyAndIndirectMeetTheReference) {
  const Material shiny{.albedo = glm::dvec3(0.4), .roughness = 0.4, .specular = glm::dvec3(0.5)};
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0}, shiny);
  scene.sky = {{0.3, 0.3, 0.3}, {1.0, 1.0, 1.0}};
  StillView still(scene, 12, 9);
  const PlaneSet noisy = render_noisy(still.view, 3000);
  const PlaneSet reference = render_reference(still.view, 3025);
  for (const PlaneKind kind : {PlaneKind::kGlossy, PlaneKind::kIndirect})
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 12; ++x) {
        const glm::dvec3 truth = colour_at(reference, kind, x, y);
        EXPECT_NEAR(colour_at(noisy, kind, x, y).g, truth.g, 0.06 * truth.g + 0.01);
      }
}

// In a white furnace, lobe weights times the factor average to the lobe's directional albedo.
TEST(GlossyLobe, KeepsEnergyAndAgreesWithItsBrdf) {
  for (const double roughness : {0.15, 0.4, 0.8}) {
    Surface s;
    s.normal = s.geometric_normal = {0, 0, 1};
    s.to_viewer = glm::normalize(glm::dvec3(0.7, 0.1, 0.6));
    s.specular = glm::dvec3(0.6);
    s.roughness = roughness;
    Rng rng(1, 2, 3, 4);
    double sampled = 0.0, integrated = 0.0;
    constexpr int kCount = 200000;
    for (int i = 0; i < kCount; ++i) {
      sampled += sample_lobe(s, stratified(i % 160000, 400, rng.next2())).weight.x;
      const double z = rng.next(), phi = 2.0 * std::numbers::pi * rng.next();
      const glm::dvec3 d(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi),
                         z);
      integrated += 2.0 * std::numbers::pi * z * evaluate_lobe(s, d, roughness).x;
    }
    const double albedo = sampled / kCount * specular_factor(s).x;
    EXPECT_LT(albedo, 1.0);
    EXPECT_NEAR(albedo, integrated / kCount, roughness < 0.2 ? 0.08 : 0.02);
  }
}

// The BRDF times cosine, integrated by brute force. Half vectors as points of the plane through the
// normal's tip carry the lobe's peak at any roughness.
TEST(GlossyLobe, FactorIsTheDirectionalAlbedo) {
  for (const double roughness : {0.05, 0.15, 0.25, 0.35, 0.5, 0.8, 1.0}) {
    for (const double cosine : {0.1, 0.3, 0.65, 0.98}) {
      Surface s;
      s.normal = s.geometric_normal = {0, 0, 1};
      s.to_viewer = {std::sqrt(1.0 - cosine * cosine), 0.0, cosine};
      s.specular = {0.04, 0.5, 1.0};
      s.roughness = roughness;
      const double a2 = std::pow(roughness, 4.0);
      glm::dvec3 sum(0.0);
      constexpr int kSide = 400;
      for (int i = 0; i < kSide * kSide; ++i) {
        // tan^2 = a2 q / (1 - q) has density D(h) h.z in q.
        const glm::dvec2 q = stratified(i, kSide, glm::dvec2(0.5));
        const double tan2 = a2 * q.x / (1.0 - q.x), phi = 2.0 * std::numbers::pi * q.y;
        const double z = 1.0 / std::sqrt(1.0 + tan2), sine = std::sqrt(tan2) * z;
        const glm::dvec3 h(sine * std::cos(phi), sine * std::sin(phi), z);
        const double vh = glm::dot(s.to_viewer, h);
        const glm::dvec3 l = 2.0 * vh * h - s.to_viewer;
        if (vh <= 0.0 || l.z <= 0.0) continue;
        const double d = z * z * (a2 - 1.0) + 1.0;
        const double density = a2 / (std::numbers::pi * d * d) * z / (4.0 * vh);
        sum += evaluate_lobe(s, l, roughness) * l.z / density;
      }
      const glm::dvec3 albedo = sum / static_cast<double>(kSide * kSide);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(specular_factor(s)[c], albedo[c], 0.005)
            << roughness << ' ' << cosine << ' ' << c;
    }
  }
}

TEST(Planes, ShadowOnlySceneHasNoOtherComponents) {
  Scene scene = floor_and_box(rectangle_light(), {0.8, 2.2, -1.0});
  scene.components = {true, false, false};
  Renderer renderer(scene, small_settings(8, 6));
  const Frame frame = renderer.frame(0);
  EXPECT_EQ(frame.planes.size(), 9u);  // depth, normal, objectId, five of the light, its gradients
  EXPECT_EQ(frame.planes.find({PlaneKind::kGlossy, {}}), nullptr);
  EXPECT_EQ(frame.planes.find({PlaneKind::kIndirect, {}}), nullptr);
  EXPECT_EQ(renderer.reference(0).size(), 2u);  // composite and visibility
}

}  // namespace
}  // namespace holdfast::scenes
