#include "core/motion/lobe_field.h"

#include <gtest/gtest.h>

#include "core/frame/conventions.h"
#include "core/motion/glossy_motion.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 64, kHeight = 36;

/// A tilted floor that reflects something at `hit_m` metres everywhere.
struct Floor {
  Guides guides = test::empty_guides(test::perspective_camera(kWidth, kHeight), kWidth, kHeight);
  Plane direction{{PlaneKind::kGlossyDirection, {}}, kWidth, kHeight};
  Plane distance{{PlaneKind::kGlossyHitDistance, {}}, kWidth, kHeight};
  Channels<float> out{kWidth, kHeight, 1 + kEffectFieldChannels};

  Floor(float roughness, float hit_m) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 1, 0.8f));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) test::set_pixel(guides, x, y, 4.0f, normal, 1);
    guides.roughness = Channels<float>(kWidth, kHeight, 1);
    test::fill(guides.roughness[0], roughness);
    test::fill(direction.channel(1), 1.0f);
    test::fill(distance.channel(0), hit_m);
  }
  void run() {
    for (int c = 0; c < out.count(); ++c) test::fill(out[c], 77.0f);
    measure_lobes(guides, {&direction, &distance, nullptr}, out, 1);
  }
  float field(int c, int x, int y) const { return out[1 + c].at(x, y); }
  /// The covariance in px^2 that the precision stands for.
  glm::dmat2 covariance(int x, int y) const {
    const double e = field(kFieldPrecision, x, y), f = field(kFieldPrecision + 1, x, y),
                 g = field(kFieldPrecision + 2, x, y);
    return glm::inverse(2.0 * glm::dmat2(e, f, f, g));
  }
};

// A pixel's own variance, 2.5 px^2, and half the lobe's along each of its axes.
TEST(LobeField, CovarianceIsThatOfTheLobeOnTheAxesOfIncidence) {
  Floor floor(0.25f, 3.0f);
  floor.run();
  const glm::dmat4 pixel = floor.guides.view.pixel_from_relative;
  for (int y = 0; y < kHeight; y += 5)
    for (int x = 0; x < kWidth; x += 5) {
      const glm::dvec3 s(floor.guides.position_at(x, y)), n(floor.guides.normal_at(x, y));
      const double view_m = glm::length(s), cosine = std::abs(glm::dot(s, n)) / view_m;
      const auto spread = glossy_spread(1 / floor.guides.view.pixel_angle,
                                        ggx_alpha_from_roughness(0.25), view_m, 3.0, cosine);
      const glm::dvec2 along = incidence_axis(pixel, s, n), across(-along.y, along.x);
      const glm::dmat2 got = floor.covariance(x, y);
      const double in = 2.5 + 0.5 * spread.in_plane * spread.in_plane;
      const double out = 2.5 + 0.5 * spread.out_of_plane * spread.out_of_plane;
      ASSERT_GT(in, out);
      EXPECT_NEAR(glm::dot(along, got * along), in, 2e-3 * in) << x << ", " << y;
      EXPECT_NEAR(glm::dot(across, got * across), out, 2e-3 * out) << x << ", " << y;
      EXPECT_NEAR(glm::dot(along, got * across), 0, 2e-3 * in) << x << ", " << y;
      EXPECT_EQ(floor.field(kFieldValid, x, y), 1.0f);
      EXPECT_EQ(floor.field(kFieldRatio, x, y), 0.0f);
    }
}

TEST(LobeField, WidensWithRoughnessAndDistanceUpToTheCap) {
  double before = 0;
  for (const float roughness : {0.0f, 0.2f, 0.4f, 0.6f}) {
    Floor floor(roughness, 3.0f);
    floor.run();
    const double area = glm::determinant(floor.covariance(30, 20));
    EXPECT_GT(area, before) << roughness;
    before = area;
  }
  before = 0;
  for (const float hit_m : {0.0f, 0.5f, 5.0f, test::kInf}) {
    Floor floor(0.3f, hit_m);
    floor.run();
    const double area = glm::determinant(floor.covariance(30, 20));
    EXPECT_GT(area, before) << hit_m;
    before = area;
  }
  Floor widest(1.0f, test::kInf);
  widest.run();
  const glm::dmat2 covariance = widest.covariance(30, 20);
  const double cap = double{kWidestGlossySpreadPx};
  EXPECT_LE(covariance[0][0] + covariance[1][1], 2 * (2.5 + 0.5 * cap * cap) * 1.001);
}

TEST(LobeField, OfAMirrorOrAtContactIsThePixelsOwn) {
  for (const bool contact : {false, true}) {
    Floor floor(contact ? 0.7f : 0.0f, contact ? 0.0f : 3.0f);
    floor.run();
    EXPECT_NEAR(floor.field(kFieldPrecision, 9, 9), 0.2f, 1e-5f);
    EXPECT_NEAR(floor.field(kFieldPrecision + 1, 9, 9), 0.0f, 1e-6f);
    EXPECT_NEAR(floor.field(kFieldPrecision + 2, 9, 9), 0.2f, 1e-5f);
  }
}

TEST(LobeField, SaysNothingWhereNothingWasSampled) {
  Floor floor(0.3f, 3.0f);
  test::set_pixel(floor.guides, 1, 1, 0.0f, glm::vec3(0));
  floor.direction.channel(1).at(2, 1) = 0.0f;
  floor.distance.channel(0).at(3, 1) = -1.0f;
  floor.distance.channel(0).at(4, 1) = test::kNaN;
  floor.run();
  for (const int x : {1, 2, 3, 4})
    for (int c = 0; c < kEffectFieldChannels; ++c) EXPECT_EQ(floor.field(c, x, 1), 0.0f) << x;
  EXPECT_EQ(floor.field(kFieldValid, 5, 1), 1.0f);
  EXPECT_EQ(floor.out[0].at(5, 1), 77.0f) << "not one of its channels";
}

TEST(LobeField, PrecisionIsHalfTheInverseOfACovariance) {
  const glm::vec3 p = precision_of_covariance(4, 1, 2);
  EXPECT_FLOAT_EQ(p.x, 0.5f * 2 / 7);
  EXPECT_FLOAT_EQ(p.y, -0.5f * 1 / 7);
  EXPECT_FLOAT_EQ(p.z, 0.5f * 4 / 7);
  const glm::vec3 flat = precision_of_covariance(1e-10f, 0, 1e-10f);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(flat[k]));
}

}  // namespace
}  // namespace holdfast
