#include "client/measure/markdown.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/sequence/temp_dir.h"

namespace holdfast::measure {
namespace {

/// A scene whose recipes have the RMSE 0.2 and 0.1 and take 4 and 5 ms; its glossy never moves.
ReportScene made_scene() {
  ReportScene scene{"fence", "", "", {}};
  double rmse = 0.2, ms = 4;
  for (const char* recipe : {"traditional", "reliable"}) {
    LayerErrors errors;
    errors.rmse = rmse;
    errors.ssim = 1 - rmse;
    errors.judged_pixels = 9;
    LayerErrors none;
    none.rmse = none.ssim = std::numeric_limits<double>::quiet_NaN();
    ReportResult result{recipe, "", {}, ms};
    result.comparison.layers = {{"light0.visibility", Measure::kClip, errors, errors},
                                {"glossy", Measure::kTonemap, errors, none}};
    scene.results.push_back(result);
    rmse /= 2;
    ms += 1;
  }
  scene.reference_noise = {{"light0.visibility", 0.001, 0.02}};
  return scene;
}

std::string read(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Markdown, HasARowForEachRecipeWithTheBestInBold) {
  const std::string text = quality_markdown({made_scene()}, {});
  EXPECT_EQ(
      text,
      "| `fence` | light0.visibility, effect: RMSE | SSIM | glossy, image: RMSE | SSIM | core "
      "ms (over traditional) |\n|---|---|---|---|---|---|\n"
      "| `traditional` | 0.2000 | 0.8000 | 0.2000 | 0.8000 | 4.0 (1.00) |\n"
      "| `reliable` | **0.1000** | **0.9000** | **0.1000** | **0.9000** | 5.0 (1.25) |\n"
      "| references | 0.0200* | | | | |\n\n"
      "\\* Two references differ by more than a tenth of the best RMSE here: their noise adds to "
      "every error, draws ratios towards 1, and hides small differences.\n");
}

TEST(Markdown, ListsTheClaimsFirst) {
  const auto scene = made_scene();
  const std::string text = quality_markdown({scene}, evaluate_claims({scene}));
  EXPECT_EQ(text.find("| claim |"), 0u) << text;
  EXPECT_NE(text.find("| shadows | `fence`, light0.visibility | SSIM over that of the best other "
                      "recipe | >= 1.00 | 1.1250 | holds* |"),
            text.npos)
      << text;
}

TEST(Markdown, ReplacesOnlyWhatStandsBetweenTheMarkers) {
  const test::TempDir dir;
  const auto file = dir / "README.md";
  std::ofstream(file) << "before\n" << kTableBegin << "\nold\n" << kTableEnd << "\nafter\n";
  write_markdown(file, "new\n");
  const std::string once =
      std::string("before\n") + kTableBegin + "\nnew\n" + kTableEnd + "\nafter\n";
  EXPECT_EQ(read(file), once);
  write_markdown(file, "new\n");
  EXPECT_EQ(read(file), once);
}

TEST(Markdown, IsTheWholeFileWithoutMarkers) {
  const test::TempDir dir;
  const auto file = dir / "table.md";
  write_markdown(file, "one\n");
  write_markdown(file, "two\n");
  EXPECT_EQ(read(file), "two\n");
  EXPECT_THROW(write_markdown(dir / "missing/table.md", "text"), std::runtime_error);
}

}  // namespace
}  // namespace holdfast::measure
