#include "client/measure/report.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "client/measure/report_plot.h"
#include "client/measure/report_table.h"
#include "client/sequence/sequence.h"
#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

const PlaneId kVisibility = PlaneId::of_light(PlaneKind::kVisibility, 0);
constexpr int kWidth = 16, kHeight = 9;

PlaneSet visibility(float value) {
  PlaneSet planes;
  Plane& plane = planes.add(kVisibility, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) plane.channel(0).at(x, y) = value;
  return planes;
}

/// A scene of two frames with two results, the second one perfect.
ReportScene make_scene(const std::filesystem::path& dir) {
  SequenceHeader header;
  header.width = kWidth;
  header.height = kHeight;
  header.lights.push_back({});
  SequenceWriter writer(dir / "s", header);
  for (const char* name : {"rough", "good"}) std::filesystem::create_directories(dir / name);
  for (std::int64_t index = 0; index < 2; ++index) {
    Frame frame;
    frame.index = index;
    frame.planes = visibility(1);
    Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) std::fill_n(depth.channel(0).row(y), kWidth, 1.0f);
    frame.planes.add({PlaneKind::kNormal, {}}, kWidth, kHeight);
    writer.write_frame(frame);
    const float truth = index == 0 ? 0.25f : 0.5f;
    writer.write_reference(index, visibility(truth));
    write_exr(sequence_file(dir / "rough", "frame", index), visibility(truth + 0.25f));
    write_exr(sequence_file(dir / "good", "frame", index), visibility(truth));
  }
  writer.finish();
  CompareOptions compare_options;
  compare_options.reference = dir / "s";
  compare_options.tests = {dir / "rough", dir / "good"};
  auto comparisons = compare(compare_options);
  return {"a <scene>",
          "Two frames.",
          dir / "s",
          {{"rough", dir / "rough", comparisons[0]}, {"good", dir / "good", comparisons[1]}}};
}

std::string read(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Report, IsOnePageThatLoadsNothing) {
  const test::TempDir dir;
  write_report(dir / "report.html", {make_scene(dir.path())},
               {.title = "Title & more", .top_html = "<p>top</p>", .png_dir = dir / "png"});
  const std::string page = read(dir / "report.html");
  EXPECT_EQ(page.find("http"), page.npos);
  EXPECT_EQ(page.find("<link"), page.npos);
  EXPECT_EQ(page.find("src=\"") + 5, page.find("data:image/png;base64,"));
  // Noisy, two results and the reference, each as a picture and as an error map.
  EXPECT_EQ(occurrences(page, "data:image/png;base64,"), 8);
  EXPECT_EQ(occurrences(page, "<svg"), 2);
  EXPECT_NE(page.find("<h1>Title &amp; more</h1>"), page.npos);
  EXPECT_NE(page.find("<p>top</p><section>"), page.npos);
  EXPECT_NE(page.find("<h2>a &lt;scene&gt;</h2>"), page.npos);
  EXPECT_NE(page.find("frame 1."), page.npos);
  EXPECT_TRUE(std::filesystem::exists(dir / "png/a <scene>.light0.visibility.rough.error.png"));
}

TEST(Report, LinksItsPicturesIfAskedTo) {
  const test::TempDir dir;
  write_report(dir / "report.html", {make_scene(dir.path())},
               {.title = "Title", .png_dir = dir / "pictures", .link_pictures = true});
  const std::string page = read(dir / "report.html");
  EXPECT_EQ(page.find("data:"), page.npos);
  EXPECT_EQ(occurrences(page, "src=\"pictures/a &lt;scene&gt;.light0.visibility."), 8);
}

TEST(Report, TableTellsCostAndNoiseOfReferencesWhereKnown) {
  const test::TempDir dir;
  ReportScene scene = make_scene(dir.path());
  EXPECT_EQ(table_html(scene, 0).find("core ms"), std::string::npos);
  scene.results[0].core_ms = 1.5;
  scene.results.pop_back();
  scene.reference_noise = {{"light0.visibility", 0.001, 0.1}};
  const std::string table = table_html(scene, 0);
  EXPECT_NE(table.find("<th>core ms</th>"), table.npos);
  EXPECT_NE(table.find("<td>1.50</td></tr>"), table.npos);
  EXPECT_NE(
      table.find("RMSE of the references themselves: 0.00100 over the image; 0.10000 where the "
                 "effect moves, too much"),
      table.npos)
      << table;
}

TEST(Report, CostIsARatioToTraditional) {
  ReportScene scene{"s", "", "", {{"traditional", "", {}, 2.0}, {"reliable", "", {}, 2.5}}};
  EXPECT_EQ(core_over_traditional(scene, scene.results[1]), 1.25);
  scene.results[0].name = "svgf";
  EXPECT_TRUE(std::isnan(core_over_traditional(scene, scene.results[1])));
}

TEST(Report, BestOfEachColumnIsBold) {
  const test::TempDir dir;
  const ReportScene scene = make_scene(dir.path());
  const std::string table = table_html(scene, 0);
  EXPECT_NE(table.find("<td><b>0.0000</b></td><td><b>exact</b></td><td><b>1.0000</b></td>"),
            table.npos);                                               // the good result
  EXPECT_NE(table.find("<td>0.2500</td><td>12.04</td>"), table.npos);  // the rough one
}

TEST(Plot, PutsTheLargestErrorAtTheTopTick) {
  const std::string svg =
      plot_svg("RMSE", {{"one", {{0, 0.0}, {10, 0.1}}}, {"two & three", {{0, 0.05}}}});
  EXPECT_NE(svg.find("class=\"line c0\" points=\"52.0,226.0 628.0,12.0 \""), svg.npos) << svg;
  EXPECT_NE(svg.find("class=\"line c1\" points=\"52.0,119.0 \""), svg.npos) << svg;
  EXPECT_NE(svg.find("<title>two &amp; three</title>"), svg.npos);
}

TEST(Plot, IsEmptyWithoutAnyPoint) { EXPECT_EQ(plot_svg("RMSE", {{"one", {}}}), ""); }

TEST(Plot, FlatZeroErrorIsDrawnAtTheBottom) {
  const std::string svg = plot_svg("RMSE", {{"one", {{3, 0.0}, {4, 0.0}}}});
  EXPECT_NE(svg.find("points=\"52.0,226.0 628.0,226.0 \""), svg.npos) << svg;
}

}  // namespace
}  // namespace holdfast::measure
