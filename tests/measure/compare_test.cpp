#include "client/measure/compare.h"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/measure/comparison_text.h"
#include "client/sequence/sequence.h"
#include "tests/sequence/expect_input_error.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

using holdfast::test::expect_input_error;
using holdfast::test::TempDir;

constexpr PlaneId kComposite{PlaneKind::kComposite, {}};
const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 2);
constexpr int kWidth = 12, kHeight = 7;

void fill(Plane& plane, float value) {
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y) std::fill_n(plane.channel(c).row(y), kWidth, value);
}

PlaneSet results(float composite, float visibility) {
  PlaneSet planes;
  fill(planes.add(kComposite, kWidth, kHeight), composite);
  fill(planes.add(kVisibility, kWidth, kHeight), visibility);
  return planes;
}

/// Frames 1..4 whose upper row is sky, references for 2 and 3, results 0.25 (judged values) off.
class Compare : public testing::Test {
 protected:
  Compare() {
    SequenceHeader header{
        .width = kWidth, .height = kHeight, .frame_rate = 30, .lights = {}, .objects = {}};
    header.lights.push_back({.id = 2, .width = 1, .height = 1});
    SequenceWriter writer(dir_ / "s", header);
    std::filesystem::create_directories(dir_ / "out");
    for (std::int64_t index = 1; index <= 4; ++index) {
      Frame frame;
      frame.index = index;
      Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, kWidth, kHeight);
      fill(depth, 1);
      std::fill_n(depth.channel(0).row(0), kWidth, std::numeric_limits<float>::infinity());
      frame.planes.add({PlaneKind::kNormal, {}}, kWidth, kHeight);
      writer.write_frame(frame);
      if (index == 2 || index == 3)
        writer.write_reference(index, results(1.0f, index == 2 ? 0.5f : 0.75f));
      write_result(index, results(3.0f, 0.5f));
    }
    writer.finish();
  }

  void write_result(std::int64_t index, const PlaneSet& planes) {
    write_exr(sequence_file(dir_ / "out", "frame", index), planes);
  }
  CompareOptions options() const {
    CompareOptions out;
    out.reference = dir_ / "s";
    out.tests = {dir_ / "out"};
    return out;
  }

  TempDir dir_;
};

TEST_F(Compare, OnlyFramesWithAReferenceAreJudged) {
  for (const int unjudged : {1, 4})
    std::filesystem::remove(sequence_file(dir_ / "out", "frame", unjudged));
  const Comparison comparison = compare(options()).front();
  EXPECT_EQ(comparison.frames, 2);
  ASSERT_EQ(comparison.layers.size(), 2u);
  EXPECT_EQ(comparison.layers[0].name, "light2.visibility");
  EXPECT_EQ(comparison.layers[1].name, "composite");
  const LayerErrors& composite = comparison.layers[1].image;
  EXPECT_DOUBLE_EQ(composite.rmse, 0.25);  // 3/(1+3) - 1/(1+1)
  EXPECT_EQ(composite.judged_pixels, 2 * kWidth * (kHeight - 1));
  const LayerErrors& effect = comparison.layers[0].effect;
  EXPECT_DOUBLE_EQ(effect.rmse, 0.25);  // frame 3 alone
  EXPECT_EQ(effect.judged_pixels, kWidth * (kHeight - 1));
  EXPECT_DOUBLE_EQ(comparison.layers[0].image.flicker, 0.25);
}

TEST_F(Compare, SeveralResultsAreJudgedAsEachAlone) {
  std::filesystem::create_directories(dir_ / "good");
  for (std::int64_t index = 1; index <= 4; ++index)
    write_exr(sequence_file(dir_ / "good", "frame", index), results(1.0f, 0.5f));
  CompareOptions both = options();
  both.tests.push_back(dir_ / "good");
  const auto comparisons = compare(both);
  ASSERT_EQ(comparisons.size(), 2u);
  EXPECT_EQ(comparison_json(comparisons[0], Region::kImage),
            comparison_json(compare(options()).front(), Region::kImage));
  EXPECT_EQ(comparisons[1].layers[1].image.rmse, 0);
}

TEST_F(Compare, LayersCanBeChosen) {
  CompareOptions chosen = options();
  chosen.layers = {"composite"};
  const Comparison comparison = compare(chosen).front();
  ASSERT_EQ(comparison.layers.size(), 1u);
  EXPECT_EQ(comparison.layers[0].name, "composite");
  chosen.layers = {"depth"};
  expect_input_error([&] { compare(chosen); }, {"layer depth", "composite, light<k>.visibility"});
  chosen.layers = {"glossy"};
  expect_input_error([&] { compare(chosen); }, {"layer glossy", "references", "missing"});
}

TEST_F(Compare, MissingResultFrameIsNamed) {
  std::filesystem::remove(sequence_file(dir_ / "out", "frame", 3));
  expect_input_error([&] { compare(options()); }, {"out/frame.0003.exr", "missing"});
}

TEST_F(Compare, ResultOfAnotherSizeIsNamed) {
  PlaneSet small;
  small.add(kComposite, 3, 3);
  write_result(3, small);
  expect_input_error([&] { compare(options()); }, {"out/frame.0003.exr", "12x7", "3x3"});
}

TEST_F(Compare, ResultWithoutALayerIsNamed) {
  PlaneSet partial = results(1, 1);
  partial.remove(kComposite);
  write_result(3, partial);
  expect_input_error([&] { compare(options()); }, {"out/frame.0003.exr, layer composite"});
}

TEST_F(Compare, SequenceWithoutReferencesIsAnError) {
  CompareOptions none = options();
  none.first = 4;
  expect_input_error([&] { compare(none); }, {"reference for at least one frame"});
}

TEST_F(Compare, ReferenceThatIsNotFiniteIsAnError) {
  write_exr(sequence_file(dir_ / "s", "reference", 3),
            results(std::numeric_limits<float>::infinity(), 1));
  expect_input_error([&] { compare(options()); },
                     {"s/reference.0003.exr, layer composite", "finite"});
}

TEST_F(Compare, JsonHasTheKeysOfTheContract) {
  const auto json = comparison_json(compare(options()).front(), Region::kImage);
  EXPECT_EQ(json["frames"], 2);
  const auto& layer = json["layers"]["light2.visibility"];
  for (const char* key : {"rmse", "psnr", "ssim", "flip", "flicker"})
    EXPECT_TRUE(layer[key].is_number()) << key;
  EXPECT_EQ(layer["non_finite"], 0);
  EXPECT_EQ(layer["per_frame"][1]["frame"], 3);
  EXPECT_EQ(layer["per_frame"][1]["rmse"], 0.25);
}

TEST_F(Compare, NumbersThatDoNotExistAreNull) {
  CompareOptions quick = options();
  quick.flip = false;
  for (std::int64_t index = 2; index <= 3; ++index) write_result(index, results(1, 1));
  const auto json = comparison_json(compare(quick).front(), Region::kEffect);
  const auto& composite = json["layers"]["composite"];  // does not change: no effect
  for (const char* key : {"rmse", "psnr", "ssim", "flip", "flicker"})
    EXPECT_TRUE(composite[key].is_null()) << key;
}

}  // namespace
}  // namespace holdfast::measure
