#include <algorithm>

#include <gtest/gtest.h>

#include "core/denoiser/denoiser.h"
#include "core/frame/light.h"
#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

// A floor at y = 0 seen from straight above, a half-plane x < 0 at height 1 that blocks, and a
// rectangle light at height 3 that moves along x: the shadow's edge runs over the floor, with a
// penumbra that follows from similar triangles.
constexpr int kWidth = 96, kHeight = 48, kFrames = 20;
constexpr double kBlockerY = 1.0, kLightY = 3.0, kLightWidth = 0.8;
constexpr double kRatio = kBlockerY / kLightY;

struct Scene {
  double speed;  ///< of the light, metres a frame
  DenoiserConfig config = test::shadow_config(kWidth, kHeight);
  Camera camera = test::orthographic_camera(kWidth, kHeight);

  explicit Scene(double light_speed) : speed(light_speed) {
    config.lights[0].width = kLightWidth;
    config.lights[0].height = 0.4;
    camera.view_from_world = glm::lookAt(glm::dvec3(0, 5, 0), glm::dvec3(0), glm::dvec3(0, 0, -1));
  }
  double light_x(int index) const { return speed * (index - 0.5 * kFrames); }
  double floor_x(int x) const { return (x + 0.5 - 0.5 * kWidth) * 4.0 / kHeight; }

  /// The share of the light that a point sees: of the rays to x_l, those with s + (x_l - s) r >= 0.
  double visibility(int x, int index) const {
    const double s = floor_x(x), least = -s * (1 - kRatio) / kRatio;
    return std::clamp((light_x(index) + 0.5 * kLightWidth - least) / kLightWidth, 0.0, 1.0);
  }

  Frame frame(int index) const {
    Frame out;
    out.index = index;
    out.camera = camera;
    // Emits along local -Z, that is down; local X stays world X.
    const glm::dmat4 at = glm::translate(glm::dmat4(1), {light_x(index), kLightY, 0});
    out.lights[0] = glm::rotate(at, -1.57079632679489662, glm::dvec3(1, 0, 0));
    for (const PlaneId id : config.planes) out.planes.add(id, kWidth, kHeight);
    const auto plane = [&](PlaneId id, int c) { return out.planes.find(id)->channel(c); };
    test::Random random(100u + static_cast<std::uint32_t>(index));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double s = floor_x(x), z = (y + 0.5 - 0.5 * kHeight) * 4.0 / kHeight;
        const float u = random.real(), v = random.real();
        const glm::dvec3 l(out.lights[0] * light_point(config.lights[0], double(u), double(v)));
        const glm::dvec3 to_light = l - glm::dvec3(s, 0, z);
        const bool blocked = s + to_light.x * kRatio < 0;
        plane(test::kDepthPlane, 0).at(x, y) = 5.0f;
        plane(test::kNormalPlane, 1).at(x, y) = 1.0f;
        plane(test::of_light(PlaneKind::kVisibility), 0).at(x, y) = blocked ? 0.0f : 1.0f;
        plane(test::of_light(PlaneKind::kBlockerDistance), 0).at(x, y) =
            blocked ? static_cast<float>(kRatio * glm::length(to_light)) : test::kInf;
        plane(test::of_light(PlaneKind::kLightSample), 0).at(x, y) = u;
        plane(test::of_light(PlaneKind::kLightSample), 1).at(x, y) = v;
      }
    return out;
  }

  /// RMSE where the penumbra is in the frame or was in the last one, over the later half.
  double rmse(const std::string& recipe) const {
    DenoiserConfig with = config;
    with.recipe = recipe;
    Denoiser denoiser(with);
    double sum = 0, count = 0;
    for (int index = 0; index < kFrames; ++index) {
      const PlaneSet results = test::filtered(denoiser, frame(index));
      const auto out = results.at(test::of_light(PlaneKind::kVisibility)).channel(0);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const double now = visibility(x, index), before = visibility(x, index - 1);
          if (index < kFrames / 2 || (now == before && (now == 0 || now == 1))) continue;
          const double error = double(out.at(x, y)) - now;
          sum += error * error;
          count += 1;
        }
    }
    return std::sqrt(sum / count);
  }
};

// The generated coins themselves, so that the comparisons below rest on a true reference.
TEST(ShadowPipeline, NoiseOfTheSceneHasTheAnalyticMean) {
  const Scene scene(0.1);
  const int index = 10;
  const Frame frame = scene.frame(index);
  const auto noisy = frame.planes.at(test::of_light(PlaneKind::kVisibility)).channel(0);
  for (int x = 0; x < kWidth; ++x) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y) sum += double(noisy.at(x, y));
    // 48 coins: four standard deviations are 0.29 at most.
    EXPECT_NEAR(sum / kHeight, scene.visibility(x, index), 0.29) << x;
  }
}

TEST(ShadowPipeline, ReliableBeatsTraditionalAndSpatialOnAMovingPenumbra) {
  for (const double speed : {0.1, 0.25}) {  // the shadow moves 0.6 and 1.5 px a frame
    const Scene scene(speed);
    const double reliable = scene.rmse("reliable"), traditional = scene.rmse("traditional"),
                 spatial = scene.rmse("spatial");
    EXPECT_LT(reliable, 0.95 * traditional) << "speed " << speed;
    EXPECT_LT(reliable, 0.95 * spatial) << "speed " << speed;
    RecordProperty("rmse at speed " + std::to_string(speed),
                   std::to_string(reliable) + " against traditional " +
                       std::to_string(traditional) + " and spatial " + std::to_string(spatial));
  }
}

TEST(ShadowPipeline, ReliableBeatsSpatialOnAStillShadow) {
  const Scene scene(0.0);
  double errors[2];
  int k = 0;
  for (const char* recipe : {"reliable", "spatial"}) {
    DenoiserConfig config = scene.config;
    config.recipe = recipe;
    Denoiser denoiser(config);
    errors[k] = 0;
    for (int index = 0; index < kFrames; ++index) {
      const PlaneSet results = test::filtered(denoiser, scene.frame(index));
      if (index + 1 < kFrames) continue;
      for (int x = 0; x < kWidth; ++x)
        for (int y = 0; y < kHeight; ++y)
          errors[k] += std::pow(
              double(results.at(test::of_light(PlaneKind::kVisibility)).channel(0).at(x, y)) -
                  scene.visibility(x, index),
              2);
    }
    ++k;
  }
  EXPECT_LT(errors[0], 0.5 * errors[1]);
}

// The shadow of the moving light has its own vector: x_now - x_before = -(light's step) r / (1 -
// r).
TEST(ShadowPipeline, DebugMotionIsTheAnalyticMotionOfTheShadow) {
  Scene scene(0.25);
  scene.config.debug_planes = true;
  Denoiser denoiser(scene.config);
  for (int index = 0; index < 10; ++index) test::filtered(denoiser, scene.frame(index));
  const PlaneSet results = test::filtered(denoiser, scene.frame(10));
  const Plane& motion = results.at({PlaneKind::kDebugMotion, {ComponentKind::kVisibility, 0}});
  const double step_px = 0.25 * kRatio / (1 - kRatio) * kHeight / 4.0;
  int inside = 0;
  for (int x = 4; x < kWidth - 4; ++x) {
    if (scene.visibility(x, 10) < 0.3 || scene.visibility(x, 10) > 0.7) continue;
    ++inside;
    EXPECT_NEAR(motion.channel(0).at(x, kHeight / 2), step_px, 0.02) << x;
    EXPECT_NEAR(motion.channel(1).at(x, kHeight / 2), 0.0, 0.02) << x;
  }
  EXPECT_GT(inside, 1);
}

}  // namespace
}  // namespace holdfast
