#include "client/measure/picture.h"

#include <string_view>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "client/measure/noisy_composite.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 0);

std::string base64_of(std::string_view text) { return base64({text.begin(), text.end()}); }

TEST(Picture, Base64FollowsTheVectorsOfItsStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64({0xfb, 0xff, 0xbf}), "+/+/");
}

TEST(Picture, PngReadsBackAsItWas) {
  const test::TempDir dir;
  Picture picture{3, 2, {}};
  for (std::uint8_t i = 0; i < 18; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(14 * i));
  write_png(dir / "a.png", picture);
  const auto input = OIIO::ImageInput::open((dir / "a.png").string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().width, 3);
  EXPECT_EQ(input->spec().height, 2);
  std::vector<std::uint8_t> rgb(18);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, rgb.data()));
  EXPECT_EQ(rgb, picture.rgb);
}

TEST(Picture, VisibilityIsGreyInSrgb) {
  Plane plane(kVisibility, 3, 1);
  plane.channel(0).at(1, 0) = 0.5f;  // 188 in sRGB
  plane.channel(0).at(2, 0) = 4.0f;
  EXPECT_EQ(picture_of(plane).rgb,
            (std::vector<std::uint8_t>{0, 0, 0, 188, 188, 188, 255, 255, 255}));
}

TEST(Picture, RadianceIsTonemappedByChannel) {
  Plane plane({PlaneKind::kComposite, {}}, 1, 1);
  plane.channel(0).at(0, 0) = 1;  // judged as 0.5
  EXPECT_EQ(picture_of(plane).rgb, (std::vector<std::uint8_t>{188, 0, 0}));
}

TEST(Picture, ErrorMapGoesFromBlackToLightYellowAndSkyIsGrey) {
  Plane reference(kVisibility, 4, 1), result(kVisibility, 4, 1);
  const float errors[] = {0, 0.25f, 1, 1};
  for (int x = 0; x < 4; ++x) result.channel(0).at(x, 0) = errors[x];
  const auto rgb = error_map(result, reference, Mask{1, 1, 1, 0}).rgb;
  EXPECT_EQ(rgb, (std::vector<std::uint8_t>{0, 0, 5, 252, 255, 163, 252, 255, 163, 128, 128, 128}));
}

TEST(NoisyComposite, IsTheSumOfTheContract) {
  Frame frame;
  const auto add = [&](PlaneId id, float value) {
    Plane& plane = frame.planes.add(id, 2, 1);
    for (int c = 0; c < plane.channels(); ++c)
      for (int x = 0; x < 2; ++x) plane.channel(c).at(x, 0) = value;
  };
  add({PlaneKind::kDepth, {}}, 1);
  frame.planes.find({PlaneKind::kDepth, {}})->channel(0).at(1, 0) = 0;  // sky
  add({PlaneKind::kEmission, {}}, 0.5f);
  add(PlaneId::of_light(PlaneKind::kUnshadowed, 0), 2);
  add(kVisibility, 0.25f);
  add(PlaneId::of_light(PlaneKind::kUnshadowed, 3), 8);
  add(PlaneId::of_light(PlaneKind::kVisibility, 3), 0.5f);
  add({PlaneKind::kIndirect, {}}, 10);
  add({PlaneKind::kAlbedo, {}}, 0.3f);
  add({PlaneKind::kGlossy, {}}, 7);  // without specular
  const Plane composite = noisy_composite(frame);
  EXPECT_FLOAT_EQ(composite.channel(2).at(0, 0), 0.5f + 0.5f + 4 + 3 + 7);
  EXPECT_FLOAT_EQ(composite.channel(0).at(1, 0), 0.5f);
}

}  // namespace
}  // namespace holdfast::measure
