#include "client/measure/judged.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/measure/test_images.h"

namespace holdfast::measure {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image row(std::initializer_list<float> values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.values = values;
  return image;
}

TEST(Judged, VisibilityIsClippedToTheUnitInterval) {
  EXPECT_EQ(judged_image(row({-1, 0, 0.25f, 1, 7}), Measure::kClip).values,
            (std::vector<float>{0, 0, 0.25f, 1, 1}));
}

TEST(Judged, RadianceIsTonemapped) {
  EXPECT_EQ(judged_image(row({-1, 0, 1, 3}), Measure::kTonemap).values,
            (std::vector<float>{0, 0, 0.5f, 0.75f}));
}

TEST(Judged, OnlyVisibilityIsClipped) {
  EXPECT_EQ(measure_of(PlaneKind::kVisibility), Measure::kClip);
  for (const auto kind : {PlaneKind::kComposite, PlaneKind::kGlossy, PlaneKind::kIndirect})
    EXPECT_EQ(measure_of(kind), Measure::kTonemap);
}

TEST(Judged, ValuesThatAreNotFiniteAreCountedAndBecomeZero) {
  Plane plane({PlaneKind::kGlossy, {}}, 3, 1);
  plane.channel(0).at(0, 0) = kNan;
  plane.channel(1).at(1, 0) = kInf;
  plane.channel(2).at(2, 0) = -kInf;
  plane.channel(2).at(0, 0) = 2;
  const CleanImage clean = clean_image(plane);
  EXPECT_EQ(clean.non_finite, 3);
  EXPECT_EQ(clean.image.values, (std::vector<float>{0, 0, 0, 0, 0, 0, 2, 0, 0}));
}

TEST(Judged, SkyIsInfiniteZeroNegativeOrNanDepth) {
  Plane depth({PlaneKind::kDepth, {}}, 5, 1);
  const float values[] = {kInf, 0, -1, kNan, 2};
  for (int x = 0; x < 5; ++x) depth.channel(0).at(x, 0) = values[x];
  EXPECT_EQ(surface_mask(depth), (Mask{0, 0, 0, 0, 1}));
}

TEST(Judged, EffectIsAChangeOfMoreThanTwoPercentInAnyChannel) {
  Image now = test::constant(4, 1, {0.5f, 0.5f}), before = now;
  before.channel(0)[0] = 0.515f;  // too small
  before.channel(1)[1] = 0.475f;  // the second channel alone
  before.channel(0)[2] = 0.6f;    // sky
  EXPECT_EQ(effect_mask(now, before, Mask{1, 1, 0, 1}), (Mask{0, 1, 0, 0}));
}

}  // namespace
}  // namespace holdfast::measure
