#include <filesystem>
#include <set>

#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;

class TradeStudy : public test::ProgramTest {
 protected:
  static nlohmann::json point_of(const nlohmann::json& points, const std::string& name) {
    for (const auto& point : points)
      if (point["name"] == name) return point;
    ADD_FAILURE() << "no " << name;
    return {};
  }
  int study(Names more, const char* frames = "4") {
    more.insert(more.begin(), {"study", "--trade", "--size", "48x27", "--frames", frames,
                               "--reference-spp", "4", "--quiet"});
    return holdfast(more);
  }
};

TEST_F(TradeStudy, WritesTheDocumentedKeysTablesPageAndPlot) {
  ASSERT_EQ(
      study({"-o", path("study"), "--scenes", "fence", "--recipes", "reliable,clamp", "--json",
             path("study.json"), "--markdown", path("table.md"), "--svg", path("plot.svg")}),
      0)
      << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "study.json"));
  EXPECT_EQ(keys(json), (Names{"all", "scenes", "seconds"}));
  const auto& scene = json["scenes"]["fence"];
  EXPECT_EQ(keys(scene), (Names{"caption", "from_reference", "height", "points", "width", "wire"}));
  std::set<std::string> names;
  for (const auto& point : scene["points"]) {
    EXPECT_EQ(keys(point),
              (Names{"bytes_per_pixel", "composite_rmse", "front", "half_resolution", "history",
                     "history_bytes_per_pixel", "indirect_basis", "kernel_taps", "more_levels",
                     "ms", "name", "presets", "recipe", "rmse", "rmse_behind_front", "ssim",
                     "stages", "wire", "wire_bytes_per_pixel"}));
    EXPECT_EQ(point["wire"], "exact");
    EXPECT_GT(point["ms"], 0.0);
    EXPECT_GT(point["rmse"], 0.0);
    EXPECT_GT(point["composite_rmse"], 0.0);
    EXPECT_GT(point["bytes_per_pixel"], 0.0);
    EXPECT_TRUE(names.insert(point["name"]).second) << point["name"] << " twice";
  }
  for (const char* name : {"reliable fast", "reliable balanced", "reliable accurate", "clamp fast",
                           "reliable 9 taps cones half indirect, glossy, visibility f32"})
    EXPECT_TRUE(names.contains(name)) << name;
  const auto& balanced = point_of(scene["points"], "reliable balanced");
  const auto& compact = point_of(scene["wire"], "reliable balanced, wire compact");
  EXPECT_LT(compact["wire_bytes_per_pixel"], 0.5 * balanced["wire_bytes_per_pixel"].get<double>());
  EXPECT_NE(compact["rmse"], balanced["rmse"]) << "planes are rounded";
  EXPECT_NEAR(compact["rmse"].get<double>(), balanced["rmse"].get<double>(),
              0.02 * balanced["rmse"].get<double>());
  EXPECT_EQ(keys(scene["from_reference"]), (Names{"accurate", "balanced", "fast"}));
  const auto& fast = scene["from_reference"]["fast"]["light0.visibility"];
  const auto& same = scene["from_reference"]["balanced"]["light0.visibility"];
  EXPECT_LT(same["typical"], 1e-4) << "rounding alone";
  EXPECT_GT(fast["typical"], 1e-3) << "half resolution";
  EXPECT_GT(fast["largest"], fast["typical"]);
  EXPECT_EQ(scene["wire"].size(), 3u * 2u) << "presets under two profiles";
  EXPECT_NE(test::file_text(dir / "table.md").find("| reliable fast, wire balanced |"),
            std::string::npos);
  EXPECT_NE(test::file_text(dir / "table.md").find("| reliable fast |"), std::string::npos);
  EXPECT_EQ(test::file_text(dir / "plot.svg").rfind("<svg ", 0), 0u);
  EXPECT_NE(test::file_text(dir / "study/trade.html").find("<svg "), std::string::npos);
}

TEST_F(TradeStudy, RefusesWhatMeansNothing) {
  EXPECT_EQ(study({"--scenes", "fence"}), 2) << "no folder";
  EXPECT_EQ(study({"-o", path("study"), "--scenes", "fence", "--recipes", "nothing"}), 2);
  EXPECT_EQ(holdfast({"study", "--vectors", "--svg", path("plot.svg")}), 2);
  EXPECT_EQ(study({"-o", path("study"), "--scenes", "fence"}, "2"), 2) << "two frames are warm-up";
  EXPECT_NE(text.find("at least 3"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast
