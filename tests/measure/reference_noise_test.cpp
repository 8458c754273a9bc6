#include "client/measure/reference_noise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "client/sequence/sequence.h"
#include "core/frame/error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 0);
constexpr int kWidth = 16, kHeight = 9;

/// Left half `left`, right half `right`.
PlaneSet halves(float left, float right) {
  PlaneSet planes;
  Plane& plane = planes.add(kVisibility, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) plane.channel(0).at(x, y) = x < kWidth / 2 ? left : right;
  return planes;
}

/// Frames 0..4; references of frames 1 and 3, whose left half changes; the last row is sky.
void write_sequence(const std::filesystem::path& dir, bool with_references) {
  SequenceHeader header;
  header.width = kWidth;
  header.height = kHeight;
  header.lights.push_back({});
  SequenceWriter writer(dir, header);
  for (std::int64_t index = 0; index < 5; ++index) {
    Frame frame;
    frame.index = index;
    frame.planes = halves(1, 1);
    Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, kWidth, kHeight);
    for (int y = 0; y + 1 < kHeight; ++y) std::fill_n(depth.channel(0).row(y), kWidth, 1.0f);
    frame.planes.add({PlaneKind::kNormal, {}}, kWidth, kHeight);
    writer.write_frame(frame);
    if (with_references && index % 2 == 1)
      writer.write_reference(index, halves(index == 1 ? 0.1f : 0.5f, 0.5f));
  }
  writer.finish();
}

TEST(ReferenceNoise, IsTheDifferenceOfTwoReferencesOverRootTwo) {
  const test::TempDir dir;
  write_sequence(dir / "s", true);
  ASSERT_EQ(last_referenced_frame(dir / "s"), 3);
  PlaneSet second = halves(0.53f, 0.5f);
  second.find(kVisibility)->channel(0).at(0, kHeight - 1) = 1;  // sky does not count
  const auto noise = reference_noise(dir / "s", 3, second);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(noise[0].layer, "light0.visibility");
  EXPECT_NEAR(noise[0].effect, 0.03 / std::sqrt(2.0), 1e-6) << "the left half changed";
  EXPECT_NEAR(noise[0].image, 0.03 / 2, 1e-6) << "half of all pixels";
}

TEST(ReferenceNoise, HasNoEffectWithoutAnEarlierReference) {
  const test::TempDir dir;
  write_sequence(dir / "s", true);
  const auto noise = reference_noise(dir / "s", 1, halves(0.1f, 0.5f));
  EXPECT_EQ(noise[0].image, 0);
  EXPECT_TRUE(std::isnan(noise[0].effect));
}

TEST(ReferenceNoise, RefusesASequenceWithoutReferences) {
  const test::TempDir dir;
  write_sequence(dir / "s", false);
  EXPECT_THROW(last_referenced_frame(dir / "s"), InputError);
}

}  // namespace
}  // namespace holdfast::measure
