#include "client/measure/strip.h"

#include <gtest/gtest.h>

#include "client/measure/label.h"
#include "client/sequence/sequence.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

constexpr PlaneId kComposite{PlaneKind::kComposite, {}};

int white_pixels(const Picture& picture) {
  int count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) count += picture.rgb[i] == 255 ? 1 : 0;
  return count;
}

Picture black(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height * 3))};
}

TEST(Label, EachLetterIsAnotherPatternWithinItsCell) {
  std::vector<std::vector<std::uint8_t>> seen;
  for (char letter = 'a'; letter <= 'z'; ++letter) {
    Picture picture = black(kGlyphWidth, kGlyphHeight);
    draw_text(picture, 0, 0, std::string(1, letter), 1);
    EXPECT_GT(white_pixels(picture), 5) << letter;
    for (const auto& other : seen) EXPECT_NE(picture.rgb, other) << letter;
    seen.push_back(picture.rgb);
  }
}

TEST(Label, GrowsWithItsScaleAndIsCutAtTheEdge) {
  Picture once = black(40, 10), thrice = black(120, 30), cut = black(3, 3), space = black(9, 9);
  draw_text(once, 0, 0, "noisy", 1);
  draw_text(thrice, 0, 0, "noisy", 3);
  EXPECT_EQ(white_pixels(thrice), 9 * white_pixels(once));
  EXPECT_EQ(text_width("noisy", 3), 90);
  draw_text(cut, -2, -2, "noisy", 2);
  draw_text(space, 0, 0, "? :", 1);
  EXPECT_EQ(white_pixels(space), 0);
}

/// A sequence of two frames in which a square at (x, y) becomes light.
ReportScene square_scene(const std::filesystem::path& dir, int width, int height, int x, int y) {
  SequenceHeader header;
  header.width = width;
  header.height = height;
  SequenceWriter writer(dir / "s", header);
  const auto composite = [&](std::int64_t index) {
    PlaneSet planes;
    Plane& plane = planes.add(kComposite, width, height);
    for (int j = y; j < y + 10; ++j)
      for (int i = x; i < x + 10; ++i)
        for (int c = 0; c < 3; ++c) plane.channel(c).at(i, j) = index == 1 ? 1e9f : 0.0f;
    return planes;
  };
  std::filesystem::create_directories(dir / "reliable");
  for (std::int64_t index = 0; index < 2; ++index) {
    Frame frame;
    frame.index = index;
    Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, width, height);
    for (int j = 0; j < height; ++j) std::fill_n(depth.channel(0).row(j), width, 1.0f);
    frame.planes.add({PlaneKind::kNormal, {}}, width, height);
    writer.write_frame(frame);
    writer.write_reference(index, composite(index));
    write_exr(sequence_file(dir / "reliable", "frame", index), composite(index));
  }
  writer.finish();
  CompareOptions options;
  options.reference = dir / "s";
  options.tests = {dir / "reliable"};
  options.flip = false;
  return {"square", "", dir / "s", {{"reliable", dir / "reliable", compare(options).front()}}};
}

TEST(Strip, ShowsWhatChangesEnlarged) {
  const test::TempDir dir;
  const ReportScene scene = square_scene(dir.path(), 400, 300, 380, 280);
  const Picture strip = strip_of(scene, {"reliable", "absent"});
  EXPECT_EQ(strip.width, 3 * 196 * 2 + 2 * 8) << "noisy, reliable, reference";
  EXPECT_GT(strip.height, 150 * 2);
  // The square in two of three pictures, twice as large each way.
  EXPECT_GE(white_pixels(strip), 2 * 20 * 20);
}

TEST(Strip, ShowsAllOfASmallFrame) {
  const test::TempDir dir;
  const Picture strip = strip_of(square_scene(dir.path(), 32, 18, 3, 4), {"reliable"});
  EXPECT_EQ(strip.width, 3 * 64 + 2 * 8);
}

}  // namespace
}  // namespace holdfast::measure
