#include "core/history/taps.h"

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 6, kHeight = 5;

Guides small_wall() {
  return test::wall(test::perspective_camera(kWidth, kHeight), kWidth, kHeight);
}

Receiver receiver_of(const Guides& guides) { return {guides.position_at(0, 0), {0, 0, 1}, 1}; }

/// The weight that taps give to previous pixel (x, y), read back through `gather`.
float weight_at(const Guides& previous, const Taps& taps, int x, int y) {
  Channels<float> image(previous.view.width, previous.view.height, 1);
  image[0].at(x, y) = 1.0f;
  return gather(std::as_const(image)[0], taps);
}

float weight_sum(const Taps& taps) {
  return taps.weight[0] + taps.weight[1] + taps.weight[2] + taps.weight[3];
}

TEST(Taps, WeighTheirNeighboursBilinearly) {
  const Guides guides = small_wall();
  const Taps taps = find_taps(guides, 2.75f, 3.6f, receiver_of(guides));
  EXPECT_NEAR(weight_at(guides, taps, 2, 3), 0.75f * 0.9f, 1e-6f);
  EXPECT_NEAR(weight_at(guides, taps, 3, 3), 0.25f * 0.9f, 1e-6f);
  EXPECT_NEAR(weight_at(guides, taps, 2, 4), 0.75f * 0.1f, 1e-6f);
  EXPECT_NEAR(weight_at(guides, taps, 3, 4), 0.25f * 0.1f, 1e-6f);
}

TEST(Taps, AtAPixelsCentreAreThatPixelAlone) {
  const Guides guides = small_wall();
  const Taps taps = find_taps(guides, 4.5f, 1.5f, receiver_of(guides));
  EXPECT_EQ(weight_at(guides, taps, 4, 1), 1.0f);
}

TEST(Taps, InvalidOnesAreDroppedAndTheOthersRenormalised) {
  struct Case {
    const char* why;
    void (*spoil)(Guides&);
  };
  const Case cases[] = {{"sky", [](Guides& g) { test::set_pixel(g, 2, 2, 0.0f, glm::vec3(0), 1); }},
                        {"another object", [](Guides& g) { g.id[0].at(2, 2) = 7; }},
                        {"off the plane", [](Guides& g) { g.depth_normal[0].at(2, 2) = 20.0f; }},
                        {"another normal", [](Guides& g) {
                           test::set_pixel(g, 2, 2, 5.0f, glm::normalize(glm::vec3(1, 0, 1)), 1);
                         }}};
  for (const Case& c : cases) {
    Guides guides = small_wall();
    c.spoil(guides);
    const Taps taps = find_taps(guides, 3.0f, 3.0f, receiver_of(guides));  // 1/4 each
    EXPECT_EQ(weight_at(guides, taps, 2, 2), 0.0f) << c.why;
    EXPECT_NEAR(weight_at(guides, taps, 3, 2), 1.0f / 3, 1e-6f) << c.why;
    EXPECT_NEAR(weight_at(guides, taps, 2, 3), 1.0f / 3, 1e-6f) << c.why;
    EXPECT_NEAR(weight_at(guides, taps, 3, 3), 1.0f / 3, 1e-6f) << c.why;
  }
}

TEST(Taps, ToleranceIsTwoFootprintsAndTwentySixDegrees) {
  Guides guides = small_wall();
  const auto footprint = static_cast<float>(guides.view.pixel_angle) * 5.0f;
  const Receiver receiver = receiver_of(guides);
  guides.depth_normal[0].at(2, 2) = 5.0f + 1.9f * footprint;
  EXPECT_TRUE(find_taps(guides, 2.5f, 2.5f, receiver).any());
  EXPECT_EQ(weight_at(guides, find_taps(guides, 2.5f, 2.5f, receiver), 2, 2), 1.0f);
  guides = small_wall();
  test::set_pixel(guides, 2, 2, 5.0f, {std::sin(0.44f), 0, std::cos(0.44f)}, 1);
  EXPECT_EQ(weight_at(guides, find_taps(guides, 2.5f, 2.5f, receiver), 2, 2), 1.0f);
  test::set_pixel(guides, 2, 2, 5.0f, {std::sin(0.47f), 0, std::cos(0.47f)}, 1);
  EXPECT_EQ(weight_at(guides, find_taps(guides, 2.5f, 2.5f, receiver), 2, 2), 0.0f);
}

TEST(Taps, OutsideTheImageAreDropped) {
  const Guides guides = small_wall();
  const Taps taps = find_taps(guides, 0.25f, 2.5f, receiver_of(guides));
  EXPECT_NEAR(weight_at(guides, taps, 0, 2), 1.0f, 1e-6f);
  const Taps corner = find_taps(guides, kWidth - 0.1f, kHeight - 0.1f, receiver_of(guides));
  EXPECT_NEAR(weight_at(guides, corner, kWidth - 1, kHeight - 1), 1.0f, 1e-6f);
}

TEST(Taps, RescueTakesTheNearestValidPixelOfNine) {
  Guides guides = small_wall();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) guides.id[0].at(x, y) = 9;
  guides.id[0].at(1, 2) = 1;
  guides.id[0].at(3, 1) = 1;
  // The four taps of (2.9, 2.6) are (2..3, 2..3); of what surrounds them (3, 1) is the nearest.
  const Taps taps = find_taps(guides, 2.9f, 2.6f, receiver_of(guides));
  EXPECT_EQ(weight_at(guides, taps, 3, 1), 1.0f);
  guides.id[0].at(1, 2) = guides.id[0].at(3, 1) = 9;
  guides.id[0].at(5, 4) = 1;
  EXPECT_FALSE(find_taps(guides, 2.9f, 2.6f, receiver_of(guides)).any());
}

TEST(Taps, OnAnySurfaceIgnoreObjectPlaneAndNormal) {
  Guides guides = small_wall();
  test::set_pixel(guides, 2, 2, 50.0f, {1, 0, 0}, 77);
  test::set_pixel(guides, 3, 2, 0.0f, glm::vec3(0), 1);
  const Taps taps = find_taps_on_any_surface(guides, 3.0f, 3.0f);
  EXPECT_NEAR(weight_at(guides, taps, 2, 2), 1.0f / 3, 1e-6f);
  EXPECT_EQ(weight_at(guides, taps, 3, 2), 0.0f);
}

TEST(Taps, IdentityReadsItsPixelAtEverySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 5}, {7, 1}, {2, 2}, {17, 9}}) {
    const Guides guides = test::wall(test::perspective_camera(width, height), width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Taps identity = identity_taps(guides, x, y);
        EXPECT_EQ(weight_sum(identity), 1.0f);
        EXPECT_EQ(weight_at(guides, identity, x, y), 1.0f) << width << "x" << height;
        const auto px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        const Taps found = find_taps(guides, px, py, receiver_of(guides));
        EXPECT_EQ(weight_at(guides, found, x, y), 1.0f) << width << "x" << height;
      }
  }
}

TEST(Taps, FarOffScreenOrNotFiniteThereAreNone) {
  const Guides guides = small_wall();
  for (const float bad : {-1.0f, -2.0f, 1e9f, -1e9f, 3e38f, -3e38f, test::kInf, -test::kInf,
                          test::kNaN, 2.0f + kWidth}) {
    EXPECT_FALSE(find_taps(guides, bad, 2.5f, receiver_of(guides)).any()) << bad;
    EXPECT_FALSE(find_taps(guides, 2.5f, bad, receiver_of(guides)).any()) << bad;
    EXPECT_FALSE(find_taps_on_any_surface(guides, bad, bad).any()) << bad;
  }
}

TEST(Taps, ReceiversThatAreNotFiniteMatchNothing) {
  const Guides guides = small_wall();
  Receiver receiver = receiver_of(guides);
  receiver.normal.x = test::kNaN;
  EXPECT_FALSE(find_taps(guides, 2.5f, 2.5f, receiver).any());
  receiver = receiver_of(guides);
  receiver.point.y = test::kNaN;
  EXPECT_FALSE(find_taps(guides, 2.5f, 2.5f, receiver).any());
}

// Every position around the border, also of images one pixel wide: weights sum to 0 or 1 and read
// only inside. An image of ones in a frame of NaN shows a read outside.
TEST(Taps, NeverReadOutsideTheImage) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 4}, {4, 1}, {3, 2}, {16, 3}}) {
    const Guides guides = test::wall(test::perspective_camera(width, height), width, height);
    Channels<float> ones(width, height, 1);
    test::fill(ones[0], 1.0f);
    test::poison_padding(ones[0]);
    for (int j = -8; j <= 4 * height + 8; ++j)
      for (int i = -8; i <= 4 * width + 8; ++i) {
        const float x = 0.25f * static_cast<float>(i), y = 0.25f * static_cast<float>(j);
        const Taps taps = find_taps(guides, x, y, receiver_of(guides));
        const float value = gather(std::as_const(ones)[0], taps);
        EXPECT_NEAR(value, taps.any() ? 1.0f : 0.0f, 1e-6f) << x << ", " << y;
        const bool inside =
            x >= 0 && y >= 0 && x < static_cast<float>(width) && y < static_cast<float>(height);
        EXPECT_TRUE(taps.any() || !inside) << x << ", " << y;
      }
  }
}

TEST(Taps, OfASimilarSurfaceIgnoreTheIdButNotTheForeignOne) {
  Guides guides = small_wall();
  guides.id[0].at(2, 2) = 7;
  guides.id[0].at(3, 2) = 8;
  const Receiver receiver = receiver_of(guides);
  const Taps taps = find_similar_taps(guides, 3.0f, 3.0f, receiver, 7);
  EXPECT_EQ(weight_at(guides, taps, 2, 2), 0.0f) << "the foreign id";
  EXPECT_NEAR(weight_at(guides, taps, 3, 2), 1.0f / 3, 1e-6f) << "another id";
  EXPECT_NEAR(weight_at(guides, taps, 2, 3), 1.0f / 3, 1e-6f);
  const Taps own = find_similar_taps(guides, 3.0f, 3.0f, {receiver.point, receiver.normal, 7}, 7);
  EXPECT_NEAR(weight_at(guides, own, 2, 2), 0.25f, 1e-6f) << "foreign, but the receiver's own";
}

TEST(Taps, OfASimilarSurfaceKeepToItsPlaneNormalAndTheImage) {
  Guides guides = small_wall();
  test::set_pixel(guides, 2, 2, 20.0f, {0, 0, 1}, 3);
  test::set_pixel(guides, 3, 2, 5.0f, glm::normalize(glm::vec3(1, 0, 1)), 3);
  test::set_pixel(guides, 2, 3, 0.0f, glm::vec3(0), 3);
  const Receiver receiver = receiver_of(guides);
  EXPECT_EQ(weight_at(guides, find_similar_taps(guides, 3.0f, 3.0f, receiver, 9), 3, 3), 1.0f);
  for (const float bad : {-2.0f, 2.0f + kWidth, test::kInf, test::kNaN})
    EXPECT_FALSE(find_similar_taps(guides, bad, 2.5f, receiver, 9).any()) << bad;
  const Taps corner = find_similar_taps(guides, 0.1f, 0.1f, receiver, 9);
  EXPECT_NEAR(weight_at(guides, corner, 0, 0), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace holdfast
