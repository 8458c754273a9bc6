#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;
class StabilityStudy : public test::ProgramTest {};

TEST_F(StabilityStudy, WritesTheDocumentedKeysAndTheTable) {
  ASSERT_EQ(holdfast({"study", "--stability", "--recipes", "reliable", "--json", path("table.json"),
                      "--markdown", path("table.md"), "--quiet"}),
            0)
      << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "table.json"));
  EXPECT_EQ(keys(json), (Names{"entries", "passed"}));
  EXPECT_EQ(json["passed"], true);
  ASSERT_GT(json["entries"].size(), 60u);
  for (const auto& entry : json["entries"]) {
    EXPECT_EQ(keys(entry),
              (Names{"errors", "expected", "input", "limit", "limit_others", "name", "passed"}));
    EXPECT_EQ(keys(entry["errors"]), (Names{"reliable"}));
    EXPECT_LE(entry["errors"]["reliable"], entry["limit"]);
  }
  const std::string table = test::file_text(dir / "table.md");
  for (const char* part : {"| entry | input | expected | `reliable` | limit |", "| scale-1e6 |",
                           "| radiance-nan |", "| camera-singular |"})
    EXPECT_NE(table.find(part), table.npos) << part;
  EXPECT_EQ(table.find("**fail**"), table.npos);
  EXPECT_EQ(table.find("8192x4320"), table.npos) << "only with --large";
}

TEST_F(StabilityStudy, OfTheOracleWritesTheDocumentedKeysAndTheTable) {
  ASSERT_EQ(holdfast({"study", "--oracle", "--recipes", "spatial", "--json", path("oracle.json"),
                      "--markdown", path("oracle.md"), "--quiet"}),
            0)
      << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "oracle.json"));
  EXPECT_EQ(keys(json), (Names{"entries", "passed"}));
  EXPECT_EQ(json["passed"], true);
  ASSERT_EQ(json["entries"].size(), 3u * 13) << "of three scenes, each result and debug plane";
  for (const auto& entry : json["entries"])
    EXPECT_EQ(keys(entry), (Names{"largest", "largest_tip", "passed", "plane", "recipe", "rms",
                                  "scene", "tipped"}));
  const std::string table = test::file_text(dir / "oracle.md");
  for (const char* part : {"| recipe | stage | RMS | largest | tipped |", "| budget | vectors |",
                           "| `spatial` | visibility |", "| `spatial` | composite |"})
    EXPECT_NE(table.find(part), table.npos) << part;
}

TEST_F(StabilityStudy, RefusesUnknownRecipesAndOptionsOfOtherStudies) {
  EXPECT_EQ(holdfast({"study", "--stability", "--recipes", "magic"}), 2);
  EXPECT_NE(text.find("recipe must be one of"), text.npos) << text;
  EXPECT_EQ(holdfast({"study", "--stability", "--frames", "8"}), 2);
  EXPECT_EQ(holdfast({"study", "--stability", "--vectors"}), 2);
  EXPECT_EQ(holdfast({"study", "--vectors", "--long"}), 2);
  EXPECT_EQ(holdfast({"study", "--oracle", "--long"}), 2);
  EXPECT_EQ(holdfast({"study", "--oracle", "--recipes", "magic"}), 2);
}

}  // namespace
}  // namespace holdfast
