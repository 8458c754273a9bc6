// Both ends of a frame: repair on the way in, the shadow field of its samples, and the composite.

#include "client/stability/world.h"
#include "core/denoiser/composite.h"
#include "core/denoiser/frame_input.h"
#include "core/motion/shadow_field.h"
#include "core/oracle/composite.h"
#include "core/oracle/shadows.h"
#include "tests/oracle/stage_twins.h"

namespace holdfast {
namespace {

using oracle::Image;

constexpr float kAwkward[] = {0.0f,   -0.0f,  -1.0f,  test::kNaN, test::kInf, -test::kInf, 1e-45f,
                              1e-39f, 1e-20f, 1e-18f, 1e15f,      2e15f,      1e30f,       3e38f};

/// Fills a plane with ordinary values, a fifth of them awkward.
Plane& fill(Plane& plane, test::Random& random) {
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x)
        plane.channel(c).at(x, y) =
            random.uniform() < 0.2 ? kAwkward[random.bits() % std::size(kAwkward)] : random.real();
  return plane;
}

/// Equal in floats, value by value; a relative rounding for what has been divided.
void expect_equal(const Channels<float>& found, int first, const Image& expected, double rounding,
                  const char* what) {
  oracle::for_each_pixel(expected.width(), expected.height(), [&](int x, int y) {
    for (int c = 0; c < expected.channels(); ++c)
      ASSERT_NEAR(double{found[first + c].at(x, y)}, expected.at(x, y, c),
                  rounding * std::abs(expected.at(x, y, c)))
          << what << " at " << x << ", " << y;
  });
}

TEST(StageOracle, RepairsAgreeValueByValueOnEveryInstructionSet) {
  for (const auto& [width, height] : test::kStageSizes) {
    test::Random random(91);
    PlaneSet planes;
    for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kRoughness,
                                 PlaneKind::kGlossy, PlaneKind::kVisibility})
      fill(planes.add({kind, {}}, width, height), random);
    const ViewGeometry view(test::perspective_camera(width, height), width, height);
    oracle::RepairedGeometry repaired;
    const oracle::Surfaces surfaces = oracle::load_surfaces(planes, view, true, false, repaired);
    test::on_every_isa_and_threads([&] {
      Guides guides(width, height);
      guides.view = view;
      guides.rays = view.rays.cast<float>();
      guides.roughness = Channels<float>(width, height, 1);
      EXPECT_EQ(load_depth(planes.at({PlaneKind::kDepth, {}}), guides), repaired.depth);
      EXPECT_EQ(load_normals(planes.at({PlaneKind::kNormal, {}}), guides), repaired.normal);
      EXPECT_EQ(load_roughness(planes.at({PlaneKind::kRoughness, {}}), guides), repaired.roughness);
      expect_equal(guides.depth_normal, 0, surfaces.depth, 0, "depth");
      expect_equal(guides.roughness, 0, surfaces.roughness, 0, "roughness");
      // Values whose squares are no floats count as 0 in them: components below 1e-19 of a length.
      test::expect_close(guides.depth_normal, 1, surfaces.normal, 1e-6, 0, "normal");
      for (const PlaneKind kind : {PlaneKind::kGlossy, PlaneKind::kVisibility}) {
        const Plane& plane = planes.at({kind, {}});
        std::uint64_t values = 0;
        const Image expected = oracle::load_signal(plane, values);
        Channels<float> out(width, height, plane.channels());
        EXPECT_EQ(load_signal(plane, out), values);
        expect_equal(out, 0, expected, 0, "signal");
      }
    });
  }
}

TEST(StageOracle, ShadowFieldsOfEveryLightAgreeOnEveryInstructionSet) {
  using namespace stability;
  for (const LightShape shape : {LightShape::kRectangle, LightShape::kDisk, LightShape::kSphere,
                                 LightShape::kPoint, LightShape::kDirectional})
    for (const auto& [width, height] : test::kStageSizes) {
      SCOPED_TRACE(light_shape_name(shape));
      World world;
      world.width = width;
      world.height = height;
      world.light.shape = shape;
      const DenoiserConfig config = session_of(world);
      const Frame frame = render(world, 3);
      SceneMotion scene;
      oracle::Scene same_scene;
      scene.advance(frame, width, height, config.lights);
      same_scene.advance(frame, width, height);
      const auto plane = [&](PlaneKind kind) {
        return frame.planes.find(PlaneId::of_light(kind, 0));
      };
      const BlockerPlanes blockers{plane(PlaneKind::kBlockerDistance),
                                   plane(PlaneKind::kLightSample), plane(PlaneKind::kBlockerId)};
      Guides guides(width, height);
      guides.view = scene.view();
      guides.rays = guides.view.rays.cast<float>();
      load_depth(frame.planes.at({PlaneKind::kDepth, {}}), guides);
      load_normals(frame.planes.at({PlaneKind::kNormal, {}}), guides);
      oracle::RepairedGeometry repaired;
      const oracle::Surfaces surfaces =
          oracle::load_surfaces(frame.planes, scene.view(), false, false, repaired);
      const Image expected =
          oracle::shadow_field(surfaces, {config.lights[0], same_scene.light(0), *blockers.distance,
                                          *blockers.sample, blockers.id});
      test::on_every_isa_and_threads([&] {
        Channels<float> field(width, height, kEffectFieldChannels);
        ShadowTracer(guides, scene, config.lights[0], blockers).measure(field, 0);
        test::expect_close(field, 0, expected, 1e-4, 0, "field");
      });
    }
}

TEST(StageOracle, TheCompositeAgreesOnEveryInstructionSet) {
  for (const auto& [width, height] : test::kStageSizes) {
    test::Random random(92);
    const Guides guides = test::leaning_walls(width, height, random);
    const PlaneId shadow = PlaneId::of_light(PlaneKind::kVisibility, 0);
    const PlaneId signals[] = {shadow, {PlaneKind::kGlossy, {}}, {PlaneKind::kIndirect, {}}};
    const PlaneId factors[] = {PlaneId::of_light(PlaneKind::kUnshadowed, 0),
                               {PlaneKind::kSpecular, {}},
                               {PlaneKind::kAlbedo, {}}};
    PlaneSet input, results;
    std::vector<Image> images;
    std::vector<oracle::Term> terms;
    images.reserve(std::size(signals));
    for (std::size_t k = 0; k < std::size(signals); ++k) {
      Plane& signal = results.add(signals[k], width, height);
      Image& image = images.emplace_back(width, height, signal.channels());
      oracle::for_each_pixel(width, height, [&](int x, int y) {
        for (int c = 0; c < signal.channels(); ++c)
          image.at(x, y, c) = double{signal.channel(c).at(x, y) = random.real()};
      });
      terms.push_back({&image, &fill(input.add(factors[k], width, height), random), nullptr});
    }
    const Plane& emission = fill(input.add({PlaneKind::kEmission, {}}, width, height), random);
    const Image expected = oracle::compose(test::surfaces_of(guides), terms, &emission);
    test::on_every_isa_and_threads([&] {
      const PlaneId id{PlaneKind::kComposite, {}};
      results.add(id, width, height);
      EXPECT_EQ(compose(guides, signals, input, {}, results), 0u);
      // Of sums of terms up to 1e15.
      oracle::for_each_pixel(width, height, [&](int x, int y) {
        for (int c = 0; c < 3; ++c) {
          const double unit = std::max(std::abs(expected.at(x, y, c)), 1.0);
          const double found = double{results.at(id).channel(c).at(x, y)};
          ASSERT_NEAR(found, expected.at(x, y, c), 1e-6 * unit) << x << ", " << y;
        }
      });
    });
  }
}

}  // namespace
}  // namespace holdfast
