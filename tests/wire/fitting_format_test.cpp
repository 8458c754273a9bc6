// Which format a plane gets: the wished one only if no value changes its meaning.
#include <cmath>

#include <gtest/gtest.h>

#include "proto/plane_bytes.h"

namespace holdfast::wire {
namespace {

/// A plane of 0.5 with one other value, which is neither first nor last.
PlaneFormat fitted(PlaneKind kind, float value, PlaneFormat wished) {
  Plane plane({kind, {}}, 35, 9);
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 35; ++x) plane.channel(c).at(x, y) = 0.5f;
  plane.channel(plane.channels() - 1).at(33, 7) = value;
  return fitting_format(plane, wished);
}

PlaneFormat fitted_ids(std::uint32_t largest, PlaneFormat wished) {
  Plane plane({PlaneKind::kObjectId, {}}, 35, 9);
  plane.ids().at(34, 8) = largest;
  return fitting_format(plane, wished);
}

using enum PlaneFormat;

TEST(FittingFormat, IdsTakeTheSmallestWidthThatHoldsThem) {
  EXPECT_EQ(fitted_ids(0, kU8), kU8);
  EXPECT_EQ(fitted_ids(255, kU8), kU8);
  EXPECT_EQ(fitted_ids(256, kU8), kU16);
  EXPECT_EQ(fitted_ids(65535, kU8), kU16);
  EXPECT_EQ(fitted_ids(65536, kU8), kU32);
  EXPECT_EQ(fitted_ids(0xffffffffu, kU8), kU32);
  EXPECT_EQ(fitted_ids(3, kU16), kU16);
  EXPECT_EQ(fitted_ids(3, kU32), kU32);
}

TEST(FittingFormat, HalfKeepsInfinityAndNanButNoDistanceBeyondItsRange) {
  const auto blocker = PlaneKind::kBlockerDistance;
  EXPECT_EQ(fitted(blocker, INFINITY, kF16), kF16);
  EXPECT_EQ(fitted(blocker, NAN, kF16), kF16);
  EXPECT_EQ(fitted(blocker, 65504.0f, kF16), kF16);
  EXPECT_EQ(fitted(blocker, 65505.0f, kF16), kF32);
  EXPECT_EQ(fitted(blocker, -70000.0f, kF16), kF32);
}

TEST(FittingFormat, UnormTakesNothingThatItWouldClampOrLose) {
  const auto visibility = PlaneKind::kVisibility;
  EXPECT_EQ(fitted(visibility, 1.0f, kUnorm8), kUnorm8);
  EXPECT_EQ(fitted(visibility, 0.0f, kUnorm8), kUnorm8);
  EXPECT_EQ(fitted(visibility, 1.000007f, kUnorm16), kUnorm16) << "within half a step of 1";
  EXPECT_EQ(fitted(visibility, 1.00001f, kUnorm8), kF16);
  EXPECT_EQ(fitted(visibility, 1e6f, kUnorm8), kF32);
  EXPECT_EQ(fitted(visibility, -0.1f, kUnorm8), kF16);
  EXPECT_EQ(fitted(visibility, NAN, kUnorm8), kF16);
  EXPECT_EQ(fitted(visibility, INFINITY, kUnorm8), kF16);
  EXPECT_EQ(fitted(visibility, 1.5f, kUnorm16), kF32) << "half has larger steps than unorm16";
}

TEST(FittingFormat, SharedExponentTakesColoursWithoutSignOnly) {
  const auto glossy = PlaneKind::kGlossy;
  EXPECT_EQ(fitted(glossy, 65408.0f, kRgb9e5), kRgb9e5);
  EXPECT_EQ(fitted(glossy, 65409.0f, kRgb9e5), kF16);
  EXPECT_EQ(fitted(glossy, -1e-9f, kRgb9e5), kF16);
  EXPECT_EQ(fitted(glossy, NAN, kRgb9e5), kF16);
  EXPECT_EQ(fitted(glossy, 1e10f, kRgb9e5), kF32);
}

TEST(FittingFormat, DirectionsAlwaysFit) {
  for (const float value : {0.0f, NAN, INFINITY, -7.0f})
    EXPECT_EQ(fitted(PlaneKind::kGlossyDirection, value, kOctahedral16), kOctahedral16);
}

TEST(FittingFormat, RadianceInTinyUnitsStaysWhole) {
  Plane plane({PlaneKind::kIndirect, {}}, 8, 8);
  EXPECT_EQ(fitting_format(plane, kRgb9e5), kRgb9e5) << "black";
  plane.channel(1).at(3, 3) = 1e-5f;
  EXPECT_EQ(fitting_format(plane, kRgb9e5), kF32);
  EXPECT_EQ(fitting_format(plane, kF16), kF32);
  plane.channel(1).at(3, 3) = 0.001f;
  EXPECT_EQ(fitting_format(plane, kF16), kF16);
}

TEST(PlaneFormats, SuitIdsAsIdsAndDirectionsAndColoursWithThreeChannels) {
  EXPECT_TRUE(format_suits(kF16, PlaneKind::kDepth));
  EXPECT_FALSE(format_suits(kU16, PlaneKind::kDepth));
  EXPECT_TRUE(format_suits(kU16, PlaneKind::kGlossyHitId));
  EXPECT_FALSE(format_suits(kF32, PlaneKind::kGlossyHitId));
  EXPECT_TRUE(format_suits(kOctahedral16, PlaneKind::kNormal));
  EXPECT_FALSE(format_suits(kOctahedral16, PlaneKind::kAlbedo));
  EXPECT_FALSE(format_suits(kOctahedral16, PlaneKind::kMotion));
  EXPECT_TRUE(format_suits(kRgb9e5, PlaneKind::kComposite));
  EXPECT_FALSE(format_suits(kRgb9e5, PlaneKind::kNormal));
  EXPECT_FALSE(format_suits(kRgb9e5, PlaneKind::kVisibility));
}

TEST(PlaneFormats, NumbersOfTheProtocolAreCheckedAgainstThePlane) {
  EXPECT_EQ(format_from_number(0, PlaneKind::kDepth), kF32);
  EXPECT_EQ(format_from_number(0, PlaneKind::kObjectId), kU32);
  EXPECT_EQ(format_from_number(2, PlaneKind::kDepth), kF16);
  for (const int number : {-1, 5, 6, 7, 9, 10, 1000})
    EXPECT_EQ(format_from_number(number, PlaneKind::kDepth), std::nullopt) << number;
  EXPECT_EQ(format_number(kF32, PlaneKind::kDepth), 0) << "as clients without formats say it";
  EXPECT_EQ(format_number(kF16, PlaneKind::kDepth), 2);
}

}  // namespace
}  // namespace holdfast::wire
