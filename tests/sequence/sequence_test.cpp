#include "client/sequence/sequence.h"

#include <gtest/gtest.h>

#include "tests/sequence/expect_input_error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast {
namespace {

using test::expect_input_error;
using test::TempDir;

constexpr PlaneId kDepth{PlaneKind::kDepth, {}};
constexpr PlaneId kNormal{PlaneKind::kNormal, {}};
constexpr PlaneId kComposite{PlaneKind::kComposite, {}};

SequenceHeader sample_header() {
  SequenceHeader header;
  header.width = 8;
  header.height = 5;
  header.frame_rate = 24;
  header.lights = {{.id = 0, .shape = LightShape::kRectangle, .width = 1.5, .height = 0.5},
                   {.id = 3, .shape = LightShape::kSphere, .radius = 0.25},
                   {.id = 4, .shape = LightShape::kPoint}};
  header.objects = {{7, "fence"}, {4000000000u, "far \"away\""}};
  return header;
}

Frame sample_frame(std::int64_t index) {
  Frame frame;
  frame.index = index;
  frame.camera.view_from_world[3] = {1e7, 0.1, -2.0 / 3.0, 1};
  frame.camera.jitter_px = {0.25, -0.125};
  frame.planes.add(kDepth, 8, 5);
  frame.planes.add(kNormal, 8, 5);
  return frame;
}

PlaneSet composite(float value) {
  PlaneSet planes;
  planes.add(kComposite, 8, 5).channel(1).at(7, 4) = value;
  return planes;
}

TEST(Sequence, EverythingWrittenIsReadBack) {
  const TempDir dir;
  Frame second = sample_frame(5);
  second.cut = true;
  second.objects[4000000000u][3] = {1, 2, 3, 1};
  second.lights[3][3] = {4, 5, 6, 1};
  {
    SequenceWriter writer(dir / "s", sample_header());
    writer.write_frame(sample_frame(1));
    writer.write_frame(second);
    writer.write_reference(5, composite(0.5f));
    writer.finish();
  }
  const SequenceReader reader(dir / "s");
  EXPECT_EQ(reader.header().width, 8);
  EXPECT_EQ(reader.header().height, 5);
  EXPECT_EQ(reader.header().frame_rate, 24);
  EXPECT_EQ(reader.header().objects, sample_header().objects);
  ASSERT_EQ(reader.header().lights.size(), 3u);
  EXPECT_EQ(reader.header().lights[0].width, 1.5);
  EXPECT_EQ(reader.header().lights[1].radius, 0.25);
  EXPECT_EQ(reader.header().lights[2].shape, LightShape::kPoint);
  EXPECT_EQ(reader.frame_indices(), (std::vector<std::int64_t>{1, 5}));
  EXPECT_EQ(reader.planes().size(), 2u);
  EXPECT_FALSE(reader.has_reference(1));
  ASSERT_TRUE(reader.has_reference(5));
  EXPECT_EQ(reader.read_reference(5).at(kComposite).channel(1).at(7, 4), 0.5f);

  const Frame frame = reader.read_frame(5);
  EXPECT_TRUE(frame.cut);
  EXPECT_EQ(frame.camera.view_from_world, second.camera.view_from_world);
  EXPECT_EQ(frame.camera.jitter_px, second.camera.jitter_px);
  EXPECT_EQ(frame.objects, second.objects);
  EXPECT_EQ(frame.lights, second.lights);
  EXPECT_TRUE(reader.read_frame(1).objects.empty());
}

constexpr PlaneId kGradient{PlaneKind::kGradient, {ComponentKind::kGlossy, 0}};

/// Two frames with gradients in `dir`.
void write_with_gradients(const std::filesystem::path& dir) {
  SequenceWriter writer(dir, sample_header());
  for (const std::int64_t index : {0, 1}) {
    Frame frame = sample_frame(index);
    frame.planes.add(kGradient, 3, 2).channel(1).at(2, 1) = 4.0f + static_cast<float>(index);
    writer.write_frame(frame);
  }
  writer.finish();
}

TEST(Sequence, GradientsHaveOneSampleForEach3x3StratumInAFileOfTheirOwn) {
  const TempDir dir;
  write_with_gradients(dir / "s");
  EXPECT_EQ(exr_planes(dir / "s/gradient.0001.exr", ImageSize{3, 2}), std::vector{kGradient});
  const SequenceReader reader(dir / "s");
  ASSERT_TRUE(reader.has_gradients());
  EXPECT_EQ(reader.read_frame(1).planes.find(kGradient), nullptr) << "only where asked for";
  EXPECT_EQ(reader.planes().size(), 2u);
  EXPECT_EQ(reader.planes(true).back(), kGradient);
  EXPECT_EQ(reader.read_frame(1, true).planes.at(kGradient).channel(1).at(2, 1), 5.0f);
  SequenceWriter writer(dir / "t", sample_header());
  Frame frame = sample_frame(0);
  frame.planes.add(kGradient, 8, 5);
  expect_input_error([&] { writer.write_frame(frame); }, {"gradient.glossy", "3x2", "8x5"});
}

TEST(Sequence, WithoutGradientsGivesNone) {
  const TempDir dir;
  SequenceWriter writer(dir / "s", sample_header());
  writer.write_frame(sample_frame(0));
  writer.finish();
  const SequenceReader reader(dir / "s");
  EXPECT_FALSE(reader.has_gradients());
  EXPECT_EQ(reader.read_frame(0, true).planes.size(), 2u);
  EXPECT_EQ(reader.planes(true).size(), 2u);
}

TEST(Sequence, NamesWhatIsWrongWithAGradientFile) {
  const TempDir dir;
  write_with_gradients(dir / "s");
  const SequenceReader reader(dir / "s");
  const std::string file = "gradient.0001.exr";
  const auto read_with = [&](PlaneId id, int width, int height) {
    PlaneSet planes;
    planes.add(id, width, height);
    write_exr(dir / "s" / file, planes);
    return [&] { reader.read_frame(1, true); };
  };
  expect_input_error(read_with(kGradient, 8, 5), {file, "3x2", "8x5"});
  expect_input_error(read_with({PlaneKind::kGlossy, {}}, 3, 2),
                     {file, "must hold gradient planes only", "glossy"});
  expect_input_error(
      read_with({PlaneKind::kGradient, {ComponentKind::kVisibility, 99}}, 3, 2),
      {file, "gradient.light99.visibility", "light of sequence.json", "unknown light 99"});
  std::filesystem::remove(dir / "s" / file);
  expect_input_error([&] { reader.read_frame(1, true); }, {file, "missing"});
}

TEST(Sequence, AnOldSequenceLeavesNoReferenceBehind) {
  const TempDir dir;
  {
    SequenceWriter writer(dir / "s", sample_header());
    writer.write_frame(sample_frame(0));
    writer.write_reference(0, composite(1));
    writer.finish();
  }
  SequenceWriter writer(dir / "s", sample_header());
  writer.write_frame(sample_frame(0));
  writer.finish();
  EXPECT_FALSE(SequenceReader(dir / "s").has_reference(0));
}

TEST(Sequence, WriterRefusesWhatItCouldNotReadAgain) {
  const TempDir dir;
  SequenceWriter writer(dir / "s", sample_header());
  writer.write_frame(sample_frame(4));
  expect_input_error([&] { writer.write_frame(sample_frame(4)); }, {"frame 4", "after 4"});
  Frame frame = sample_frame(5);
  frame.camera.view_from_world[0][0] = NAN;
  expect_input_error([&] { writer.write_frame(frame); }, {"frame 5, viewFromWorld", "finite"});
  frame = sample_frame(5);
  frame.lights[9] = glm::dmat4(1);
  expect_input_error([&] { writer.write_frame(frame); }, {"frame 5", "light 9"});
  frame = sample_frame(5);
  frame.planes.add({PlaneKind::kRoughness, {}}, 8, 4);
  expect_input_error([&] { writer.write_frame(frame); }, {"roughness", "8x5", "8x4"});
}

/// A sequence of frame 0 with the given planes, then read.
void read_frame_with(const PlaneSet& planes) {
  const TempDir dir;
  SequenceWriter writer(dir / "s", sample_header());
  writer.write_frame(sample_frame(0));
  writer.finish();
  write_exr(dir / "s/frame.0000.exr", planes);
  SequenceReader(dir / "s").read_frame(0);
}

TEST(Sequence, FrameWithoutDepthOrNormalIsAnError) {
  PlaneSet planes;
  planes.add(kDepth, 8, 5);
  expect_input_error([&] { read_frame_with(planes); }, {"frame.0000.exr", "normal.X", "missing"});
}

TEST(Sequence, PlaneOfAnUnknownLightIsAnError) {
  Frame frame = sample_frame(0);
  frame.planes.add(PlaneId::of_light(PlaneKind::kVisibility, 1), 8, 5);
  expect_input_error([&] { read_frame_with(frame.planes); },
                     {"light1.visibility", "unknown light"});
}

TEST(Sequence, ResultInAFrameIsAnError) {
  Frame frame = sample_frame(0);
  frame.planes.add(kComposite, 8, 5);
  expect_input_error([&] { read_frame_with(frame.planes); }, {"frame.0000.exr", "composite"});
}

TEST(Sequence, MissingFrameFileIsNamed) {
  const TempDir dir;
  SequenceWriter writer(dir / "s", sample_header());
  writer.write_frame(sample_frame(12));
  writer.finish();
  std::filesystem::remove(dir / "s/frame.0012.exr");
  const SequenceReader reader(dir / "s");
  expect_input_error([&] { reader.read_frame(12); }, {"frame.0012.exr", "missing"});
  expect_input_error([&] { reader.read_frame(13); }, {"without frame 13"});
  expect_input_error([&] { SequenceReader(dir / "none"); }, {"none", "missing"});
}

}  // namespace
}  // namespace holdfast
