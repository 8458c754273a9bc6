// Frames of the demo ray tracer without their unshadowed planes: the core computes them itself.

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "client/scenes/light_target.h"
#include "core/denoiser/denoiser.h"
#include "core/frame/error.h"
#include "core/shading/ltc.h"
#include "tests/core/expect_input_error.h"
#include "tests/core/ltc_oracle.h"
#include "tests/scenes/small_scenes.h"

namespace holdfast {
namespace {

using scenes::of_light;

using Pixels = std::vector<float>;

Pixels pixels_of(const Plane& plane) {
  Pixels out;
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      out.insert(out.end(), plane.channel(c).row(y), plane.channel(c).row(y) + plane.width());
  return out;
}

/// One rendered frame of a floor and a box under one light, and its session.
struct Rendered {
  Frame frame;
  DenoiserConfig config;

  Rendered(Light light, const glm::dvec3& light_at, const scenes::Material& floor) {
    scenes::Scene scene = scenes::floor_and_box(light, light_at, floor);
    scene.components = {true, true, true};
    const glm::dvec3 emission = scene.lights.front().emission;
    scenes::Renderer renderer(std::move(scene), scenes::small_settings());
    frame = renderer.frame(0);
    light.radiance = emission;
    config.width = 40;
    config.height = 30;
    config.lights = {light};
    config.recipe = "spatial";
    for (const Plane& plane : frame.planes) config.planes.push_back(plane.id());
  }
  void drop(PlaneId id) {
    frame.planes.remove(id);
    std::erase(config.planes, id);
  }
  Pixels composite() const {
    Denoiser denoiser(config);
    PlaneSet results;
    EXPECT_EQ(denoiser.filter(frame, results).non_finite_out, 0u);
    return pixels_of(results.at({PlaneKind::kComposite, {}}));
  }
  bool plan_mentions(const std::string& words) const {
    return Denoiser(config).plan_text().find(words) != std::string::npos;
  }
};

double largest_difference(const Pixels& a, const Pixels& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, std::abs(double(a[i]) - double(b[i])));
  return worst;
}

/// Largest difference of the composite after the unshadowed plane was dropped, over the most light
/// that the plane holds.
double difference_without_plane(Rendered rendered) {
  const Pixels before = rendered.composite();
  const Pixels light = pixels_of(rendered.frame.planes.at(of_light(PlaneKind::kUnshadowed)));
  const double brightest = double(*std::max_element(light.begin(), light.end()));
  EXPECT_GT(brightest, 0.2);
  rendered.drop(of_light(PlaneKind::kUnshadowed));
  return largest_difference(before, rendered.composite()) / brightest;
}

const scenes::Material kChalk{.albedo = {0.6, 0.5, 0.4}};
const scenes::Material kTiles{
    .albedo = {0.3, 0.2, 0.1}, .roughness = 0.5, .specular = glm::dvec3(0.4)};

TEST(ShadedLight, OfADiffuseSceneIsTheRenderersToFloatPrecision) {
  EXPECT_LT(difference_without_plane({scenes::rectangle_light(), {0.8, 2.2, -1.0}, kChalk}), 2e-5);
}

// The renderer integrates the BRDF, which a transformed cosine meets to a few per cent. Its plane
// `specular` is an approximate fit, so the test puts the exact directional albedo there.
TEST(ShadedLight, OfAGlossySceneIsTheRenderersToTheFitsPrecision) {
  const glm::dvec3 at(0.3, 2.0, -1.5);
  Rendered rendered(scenes::rectangle_light(), at, kTiles);
  const scenes::StillView still(scenes::floor_and_box(scenes::rectangle_light(), at, kTiles));
  Plane& specular = *rendered.frame.planes.find({PlaneKind::kSpecular, {}});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const auto primary = scenes::primary_at(still.view, x, y);
      if (!primary) continue;
      const scenes::Surface& s = primary->surface;
      const auto lobe = ltc_lobe(s.roughness, glm::dot(s.normal, s.to_viewer));
      const glm::dvec3 albedo = s.has_lobe() ? directional_albedo(lobe, s.specular) : glm::dvec3(0);
      for (int c = 0; c < 3; ++c) specular.channel(c).at(x, y) = static_cast<float>(albedo[c]);
    }
  EXPECT_LT(difference_without_plane(std::move(rendered)), 0.1);
}

TEST(LightTarget, LightsASmoothLobeByItsOwnRoughness) {
  for (const double roughness : {0.1, 0.19}) {
    const scenes::Material floor{.roughness = roughness, .specular = glm::dvec3(0.55)};
    const scenes::StillView still(
        scenes::floor_and_box(scenes::rectangle_light(), {0.3, 2.0, -1.5}, floor));
    const scenes::LightState& light = still.view.lights[0];
    double worst = 0, brightest = 0;
    for (int y = 1; y < 30; y += 4)
      for (int x = 4; x < 40; x += 6) {
        const auto primary = scenes::primary_at(still.view, x, y);
        if (!primary || primary->object_id != 7) continue;
        const scenes::Surface& s = primary->surface;
        ShadingPoint<double> point;
        point.position = s.position;
        point.normal = s.normal;
        point.to_viewer = s.to_viewer;
        const test::Glossy material{s.albedo, s.specular, s.roughness};
        const double truth =
            light.emission.g *
            test::brute_force(light.light, light.world_from_light, material, point, 500).g;
        brightest = std::max(brightest, truth);
        worst = std::max(worst, std::abs(scenes::LightTarget(light, s).unshadowed().g - truth));
      }
    EXPECT_GT(brightest, 1.0);
    EXPECT_LT(worst, 0.015 * brightest) << roughness;
  }
}

TEST(ShadedLight, OfEveryShapeIsTheRenderers) {
  const Light sphere{.id = 3, .shape = LightShape::kSphere, .radius = 0.5};
  const Light disk{.id = 3, .shape = LightShape::kDisk, .radius = 0.6};
  const Light point{.id = 3, .shape = LightShape::kPoint};
  for (const Light& light : {sphere, disk, point})
    EXPECT_LT(difference_without_plane({light, {0.6, 2.0, -0.8}, kChalk}), 0.02)
        << light_shape_name(light.shape);
}

TEST(ShadedLight, GivesWayToAPlaneThatIsSent) {
  Rendered rendered(scenes::rectangle_light(), {0.8, 2.2, -1.0}, kTiles);
  const Pixels with_radiance = rendered.composite();
  EXPECT_FALSE(rendered.plan_mentions("unshadowed"));
  rendered.config.lights[0].radiance = glm::dvec3(0);
  EXPECT_EQ(with_radiance, rendered.composite());
}

TEST(ShadedLight, NeedsRadianceAndAlbedo) {
  Rendered rendered(scenes::rectangle_light(), {0.8, 2.2, -1.0}, kTiles);
  rendered.drop(of_light(PlaneKind::kUnshadowed));
  const glm::dvec3 radiance = rendered.config.lights[0].radiance;
  const Pixels lit = rendered.composite();
  EXPECT_TRUE(rendered.plan_mentions("unshadowed"));
  rendered.config.lights[0].radiance = glm::dvec3(0);
  EXPECT_FALSE(rendered.plan_mentions("unshadowed"));
  EXPECT_GT(largest_difference(lit, rendered.composite()), 0.2);
  rendered.config.lights[0].radiance = radiance;
  rendered.drop({PlaneKind::kAlbedo, {}});
  EXPECT_FALSE(rendered.plan_mentions("unshadowed"));
}

TEST(ShadedLight, IsSpecularOnlyWithBothOfItsPlanesAndThePlanSaysSo) {
  Rendered rendered(scenes::rectangle_light(), {0.3, 2.0, -1.5}, kTiles);
  rendered.drop(of_light(PlaneKind::kUnshadowed));
  const std::string line = "light3.unshadowed: from the light's radiance, diffuse";
  const Pixels both = rendered.composite();
  EXPECT_TRUE(rendered.plan_mentions(line + " and specular\n"));
  rendered.drop({PlaneKind::kRoughness, {}});
  EXPECT_TRUE(rendered.plan_mentions(line + "\n"));
  EXPECT_GT(largest_difference(both, rendered.composite()), 0.01);
}

TEST(ShadedLight, IsPartOfTheMemoryAndOfTheTimedStages) {
  Rendered rendered(scenes::rectangle_light(), {0.8, 2.2, -1.0}, kChalk);
  const std::size_t before = Denoiser(rendered.config).memory_bytes();
  rendered.drop(of_light(PlaneKind::kUnshadowed));
  Denoiser denoiser(rendered.config);
  EXPECT_GT(denoiser.memory_bytes(), before);
  PlaneSet results;
  int stages = 0;
  for (const StageTime& stage : denoiser.filter(rendered.frame, results).stages)
    stages += stage.stage == "unshadowed" ? 1 : 0;
  EXPECT_EQ(stages, 1);
  EXPECT_EQ(results.find(of_light(PlaneKind::kUnshadowed)), nullptr);  // no result of its own
}

TEST(ShadedLight, MaterialsOutOfRangeAddNoMoreThanWhiteOnes) {
  for (const PlaneKind kind : {PlaneKind::kAlbedo, PlaneKind::kSpecular, PlaneKind::kRoughness})
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -1.0f, 1e30f,
                            std::numeric_limits<float>::infinity()}) {
      Rendered rendered(scenes::rectangle_light(), {0.8, 2.2, -1.0}, kTiles);
      for (const PlaneKind other : {PlaneKind::kEmission, PlaneKind::kGlossy, PlaneKind::kIndirect})
        rendered.drop({other, {}});
      for (const ComponentKind of : {ComponentKind::kGlossy, ComponentKind::kIndirect})
        rendered.drop({PlaneKind::kGradient, {of, 0}});
      rendered.drop(of_light(PlaneKind::kUnshadowed));
      Plane& plane = *rendered.frame.planes.find({kind, {}});
      for (int c = 0; c < plane.channels(); ++c)
        for (int y = 0; y < 30; ++y) std::fill_n(plane.channel(c).row(y), 40, bad);
      for (const float v : rendered.composite())
        EXPECT_TRUE(v >= 0.0f && v <= 18.0f) << plane_name(plane.id()) << ' ' << bad << ": " << v;
    }
}

TEST(ShadedLight, RadianceOutOfRangeIsRefused) {
  Rendered rendered(scenes::rectangle_light(), {0.8, 2.2, -1.0}, kChalk);
  for (const double bad : {-1.0, 2e15, double(INFINITY), double(NAN)}) {
    rendered.config.lights[0].radiance.g = bad;
    test::expect_input_error([&] { Denoiser denoiser(rendered.config); }, "radiance of light 3",
                             "0..1e15", "");
  }
}

}  // namespace
}  // namespace holdfast
