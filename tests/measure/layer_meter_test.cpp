#include "client/measure/layer_meter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/measure/test_images.h"

namespace holdfast::measure {
namespace {

const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 0);

Image row(std::initializer_list<float> values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.values = values;
  return image;
}

Plane plane(std::initializer_list<float> values) {
  Plane out(kVisibility, static_cast<int>(values.size()), 1);
  int x = 0;
  for (const float value : values) out.channel(0).at(x++, 0) = value;
  return out;
}

/// A meter of visibility with its references.
class Judge {
 public:
  void add(std::int64_t frame, std::size_t position, const Image& reference, const Plane& result,
           const Mask& surface) {
    meter_.add(track_.next(frame, position, reference, surface), result);
  }
  LayerErrors image() const { return meter_.image(); }
  LayerErrors effect() const { return meter_.effect(); }

 private:
  ReferenceTrack track_{Measure::kClip, true};
  LayerMeter meter_;
};

TEST(LayerMeter, RmseIsPooledOverPixelsAndFrames) {
  Judge judge;
  judge.add(0, 0, row({0, 0, 0, 0}), plane({0.5f, 0, 0, 0}), Mask(4, 1));
  judge.add(1, 1, row({0, 0, 0, 0}), plane({0.5f, 0.5f, 0.5f, 0}), Mask(4, 1));
  const LayerErrors errors = judge.image();
  EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(4 * 0.25 / 8));  // not the mean of two roots
  ASSERT_EQ(errors.per_frame.size(), 2u);
  EXPECT_DOUBLE_EQ(errors.per_frame[0].rmse, std::sqrt(0.25 / 4));
  EXPECT_DOUBLE_EQ(errors.per_frame[1].rmse, std::sqrt(0.75 / 4));
  EXPECT_EQ(errors.judged_pixels, 8);
}

TEST(LayerMeter, ErrorOfATenthIs20Decibels) {
  Judge judge;
  judge.add(0, 0, row({0, 0}), plane({0.1f, 0.1f}), Mask(2, 1));
  EXPECT_NEAR(judge.image().psnr, 20.0, 1e-6);
}

TEST(LayerMeter, PerfectResultHasNoErrorAndInfinitePsnr) {
  Judge judge;
  for (std::size_t i = 0; i < 2; ++i)
    judge.add(static_cast<std::int64_t>(i), i, row({0.2f, 0.7f}), plane({0.2f, 0.7f}), Mask(2, 1));
  const LayerErrors errors = judge.image();
  EXPECT_EQ(errors.rmse, 0);
  EXPECT_TRUE(std::isinf(errors.psnr));
  EXPECT_EQ(errors.ssim, 1);
  EXPECT_EQ(errors.flip, 0);
  EXPECT_EQ(errors.flicker, 0);
}

TEST(LayerMeter, SkyIsNotJudged) {
  Judge judge;
  judge.add(0, 0, row({0, 0, 0}), plane({0.3f, 1, 1}), Mask{1, 0, 0});
  EXPECT_FLOAT_EQ(static_cast<float>(judge.image().rmse), 0.3f);
  EXPECT_EQ(judge.image().judged_pixels, 1);
}

TEST(LayerMeter, ResultThatIsNotFiniteIsCountedAndJudgedAsZero) {
  Judge judge;
  judge.add(
      0, 0, row({1, 0}),
      plane({std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}),
      Mask(2, 1));
  EXPECT_EQ(judge.image().non_finite, 2);
  EXPECT_DOUBLE_EQ(judge.image().rmse, std::sqrt(0.5));
}

TEST(LayerMeter, FlickerIsTheErrorOfTheChange) {
  // The reference rises by 0.5; the result falls by 0.25 at one pixel and follows at the other. A
  // constant offset is an error but no flicker.
  Judge judge;
  judge.add(0, 0, row({0, 0}), plane({0.75f, 0.25f}), Mask(2, 1));
  judge.add(1, 1, row({0.5f, 0.5f}), plane({0.5f, 0.75f}), Mask(2, 1));
  EXPECT_DOUBLE_EQ(judge.image().flicker, std::sqrt(0.75 * 0.75 / 2));
}

TEST(LayerMeter, FlickerNeedsConsecutiveReferences) {
  Judge judge;
  judge.add(0, 0, row({0}), plane({0}), Mask(1, 1));
  judge.add(2, 2, row({1}), plane({0}), Mask(1, 1));
  EXPECT_TRUE(std::isnan(judge.image().flicker));
  judge.add(3, 3, row({1}), plane({0.25f}), Mask(1, 1));
  EXPECT_DOUBLE_EQ(judge.image().flicker, 0.25);
}

TEST(LayerMeter, FlickerLeavesOutPixelsThatWereSky) {
  Judge judge;
  judge.add(0, 0, row({0, 0}), plane({0, 0}), Mask{1, 0});
  judge.add(1, 1, row({0, 0}), plane({0.5f, 1}), Mask(2, 1));
  EXPECT_DOUBLE_EQ(judge.image().flicker, 0.5);
}

TEST(LayerMeter, EffectIsJudgedWhereTheReferenceChanged) {
  Judge judge;
  judge.add(0, 0, row({0, 0, 0}), plane({0.9f, 0.9f, 0.9f}), Mask(3, 1));
  judge.add(4, 4, row({0.5f, 0.01f, 0.5f}), plane({0.75f, 1, 0}), Mask{1, 1, 0});
  const LayerErrors errors = judge.effect();
  EXPECT_DOUBLE_EQ(errors.rmse, 0.25);  // first frame: no earlier reference; then the first pixel
  EXPECT_EQ(errors.judged_pixels, 1);
  ASSERT_EQ(errors.per_frame.size(), 1u);
  EXPECT_EQ(errors.per_frame[0].frame, 4);
}

TEST(LayerMeter, NothingJudgedIsNotANumber) {
  Judge judge;
  judge.add(0, 0, row({0}), plane({1}), Mask(1, 1));
  const LayerErrors errors = judge.effect();
  for (const double value : {errors.rmse, errors.psnr, errors.ssim, errors.flip, errors.flicker})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_TRUE(errors.per_frame.empty());
}

}  // namespace
}  // namespace holdfast::measure
