#include "client/measure/vector_meter.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/small_world.h"

namespace holdfast::measure {
namespace {

constexpr int kSize = 64;
constexpr PlaneId kVisibility{PlaneKind::kVisibility, {}};
using Draws = std::vector<std::vector<Channels<Taps>>>;

/// A ramp down the columns that has moved `shift` pixels to the right, with uniform noise of its
/// own in each half.
ReferenceHalves ramp(int shift, float noise, std::uint32_t seed) {
  test::Random random(seed);
  ReferenceHalves out{Plane(kVisibility, kSize, kSize), Plane(kVisibility, kSize, kSize)};
  for (Plane& half : out)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        half.channel(0).at(x, y) =
            0.2f + 0.008f * static_cast<float>(x - shift) + random.real(-noise, noise);
  return out;
}

/// Taps `back` pixels to the left; none in the first columns.
Channels<Taps> taps_from(int back) {
  const Guides wall = test::wall(test::orthographic_camera(kSize, kSize), kSize, kSize);
  Channels<Taps> out(kSize, kSize, 1);
  for (int y = 0; y < kSize; ++y)
    for (int x = back; x < kSize; ++x) out[0].at(x, y) = identity_taps(wall, x - back, y);
  return out;
}

/// Vectors 0 and 5 pixels back.
Draws two_vectors() {
  Draws draws(1);
  draws[0].push_back(taps_from(0));
  draws[0].push_back(taps_from(5));
  return draws;
}

RegionFigures measured(float noise, const Draws& draws) {
  const ReferenceHalves previous = ramp(0, noise, 1), now = ramp(5, noise, 2);
  const Mask everywhere(kSize * kSize, 1);
  VectorMeter meter(Measure::kClip, draws[0].size());
  meter.add({previous, now, everywhere, everywhere, draws});
  return meter.figures(Region::kImage);
}

TEST(VectorMeter, TheVectorOfTheMotionHasNoErrorAndTheOthersMissByIt) {
  const RegionFigures figures = measured(0, two_vectors());
  EXPECT_EQ(figures.pixels, kSize * kSize);
  EXPECT_EQ(figures.reference_rmse, 0);
  EXPECT_NEAR(figures.vectors[0].rmse_valid, 0.04, 1e-6);
  EXPECT_NEAR(figures.vectors[1].rmse_valid, 0, 1e-6);
  EXPECT_NEAR(figures.vectors[1].share_valid, (kSize - 5.0) / kSize, 1e-12);
  EXPECT_NEAR(figures.vectors[1].rmse_fallback, 0.04 * std::sqrt(5.0 / kSize), 1e-6)
      << "five columns fall back";
}

TEST(VectorMeter, NoiseOfReferencesCancels) {
  const RegionFigures figures = measured(0.1f, two_vectors());
  const double sigma = 0.1 / std::sqrt(3.0);
  EXPECT_NEAR(figures.reference_rmse, sigma, 0.03 * sigma);
  // The mean of 4096 products of two errors of variance 2 sigma^2 is off by 2 sigma^2 / 64.
  EXPECT_LT(figures.vectors[1].rmse_valid, sigma * std::sqrt(3 * 2.0 / 64));
  EXPECT_NEAR(figures.vectors[0].rmse_valid, 0.04, 0.004) << "and not the noise of the halves";
}

TEST(VectorMeter, TheMeanOfDrawsMissesByTheMeanOfTheirMisses) {
  Draws draws(2);
  for (const int d : {0, 1}) {
    draws[static_cast<std::size_t>(d)].push_back(taps_from(5));
    draws[static_cast<std::size_t>(d)].push_back(taps_from(5 + (d == 0 ? -2 : 2)));
  }
  const RegionFigures figures = measured(0, draws);
  EXPECT_NEAR(figures.vectors[1].rmse_valid, 2 * 0.008, 1e-6);
  EXPECT_LT(figures.vectors[1].rmse_mean, 0.3 * 0.008) << "misses to both sides cancel";
}

/// Ids 1 left of column `edge`, 2 from there on.
Plane ids_with_edge(int edge) {
  Plane out({PlaneKind::kObjectId, {}}, kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) out.ids().at(x, y) = x < edge ? 1u : 2u;
  return out;
}

TEST(VectorMeter, TheEffectIsWhatIsSaidToBe) {
  const ReferenceHalves previous = ramp(0, 0, 1), now = ramp(5, 0, 1);
  const Mask everywhere(kSize * kSize, 1);
  Mask effect(kSize * kSize, 0);
  effect[9 * kSize + 40] = 1;
  VectorMeter meter(Measure::kClip, 2);
  meter.add({previous, now, everywhere, effect, two_vectors()});
  EXPECT_EQ(meter.figures(Region::kEffect).pixels, 1);
  EXPECT_NEAR(meter.figures(Region::kEffect).vectors[0].rmse_valid, 0.04, 1e-6);
  EXPECT_EQ(meter.figures(Region::kImage).pixels, kSize * kSize);
}

TEST(MovingEffect, IsWhereReferencesChangeAndNotWhereTheyAreNoisy) {
  const Plane ids = ids_with_edge(32);
  const Mask everywhere(kSize * kSize, 1);
  const ReferenceHalves previous = ramp(0, 0.05f, 1);
  ReferenceHalves now = ramp(0, 0.05f, 2);
  for (Plane& half : now)
    for (int y = 20; y < 40; ++y)
      for (int x = 32; x < 52; ++x) half.channel(0).at(x, y) += 0.1f;
  const auto count = [&](int radius) {
    const Mask mask = moving_effect(previous, now, ids, ids, radius, everywhere);
    EXPECT_TRUE(mask[30 * kSize + 40]);
    return std::count(mask.begin(), mask.end(), 1);
  };
  EXPECT_GT(count(0), 2 * 400) << "noise passes for change";
  EXPECT_NEAR(static_cast<double>(count(2)), 400 + 64, 60) << "with a rim of a pixel, but not on "
                                                              "the other side of the edge of ids";
  const Mask mask = moving_effect(previous, now, ids, ids, 2, everywhere);
  int beyond = 0;
  for (int y = 0; y < kSize; ++y) beyond += mask[static_cast<std::size_t>(y * kSize + 31)];
  EXPECT_LT(beyond, 3);
}

TEST(VectorMeter, NothingMeasuredIsNotANumber) {
  const VectorMeter meter(Measure::kClip, 1);
  EXPECT_TRUE(std::isnan(meter.figures(Region::kImage).vectors[0].rmse_valid));
}

}  // namespace
}  // namespace holdfast::measure
