#include "proto/wire_profile.h"

#include <gtest/gtest.h>

namespace holdfast::wire {
namespace {

constexpr PlaneSize kPixel{1, 1};

std::size_t bytes_of(const std::vector<PlaneId>& planes,
                     const std::array<PlaneCoding, kPlaneKindCount>& codings) {
  std::size_t bytes = 0;
  for (const PlaneId id : planes)
    bytes += plane_bytes(id, kPixel, codings[static_cast<std::size_t>(id.kind)].format);
  return bytes;
}

/// What all three components need, with one light and without materials.
const std::vector<PlaneId> kGeometryAndNoise{{PlaneKind::kDepth, {}},
                                             {PlaneKind::kNormal, {}},
                                             {PlaneKind::kObjectId, {}},
                                             PlaneId::of_light(PlaneKind::kVisibility, 0),
                                             PlaneId::of_light(PlaneKind::kBlockerDistance, 0),
                                             PlaneId::of_light(PlaneKind::kBlockerId, 0),
                                             PlaneId::of_light(PlaneKind::kLightSample, 0),
                                             {PlaneKind::kGlossy, {}},
                                             {PlaneKind::kGlossyDirection, {}},
                                             {PlaneKind::kGlossyHitDistance, {}},
                                             {PlaneKind::kGlossyHitId, {}},
                                             {PlaneKind::kIndirect, {}},
                                             {PlaneKind::kIndirectDirection, {}}};

TEST(WireProfile, NamesAreThoseOfTheDocumentation) {
  EXPECT_EQ(profile_names(), (std::vector<std::string>{"exact", "balanced", "compact"}));
  for (const std::string& name : profile_names()) EXPECT_EQ(find_profile(name)->name, name);
  EXPECT_EQ(find_profile("tight"), nullptr);
  EXPECT_EQ(find_profile(""), nullptr);
}

TEST(WireProfile, EveryCodingSuitsItsPlane) {
  for (const std::string& name : profile_names())
    for (int i = 0; i < kPlaneKindCount; ++i) {
      const auto kind = static_cast<PlaneKind>(i);
      const auto index = static_cast<std::size_t>(i);
      EXPECT_TRUE(format_suits(find_profile(name)->input[index].format, kind)) << name << " " << i;
      EXPECT_TRUE(format_suits(find_profile(name)->result[index].format, kind)) << name << " " << i;
    }
}

TEST(WireProfile, ExactIsFullAndPlain) {
  for (int i = 0; i < kPlaneKindCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_EQ(exact_profile().input[index], full_coding(static_cast<PlaneKind>(i)));
    EXPECT_EQ(exact_profile().result[index], full_coding(static_cast<PlaneKind>(i)));
  }
  EXPECT_EQ(bytes_of(kGeometryAndNoise, exact_profile().input), 96u);
}

TEST(WireProfile, CompactTakesAtMost36BytesOfAPixelWithoutMaterials) {
  EXPECT_LE(bytes_of(kGeometryAndNoise, find_profile("compact")->input), 36u);
}

TEST(WireProfile, WiderFormatsSuitWhatNarrowerOnesDo) {
  for (int number = 1; number <= 9; ++number)
    for (int i = 0; i < kPlaneKindCount; ++i) {
      const auto format = static_cast<PlaneFormat>(number);
      const auto kind = static_cast<PlaneKind>(i);
      if (!format_suits(format, kind)) continue;
      EXPECT_TRUE(format_suits(wider_format(format), kind)) << format_name(format) << " " << i;
    }
}

}  // namespace
}  // namespace holdfast::wire
