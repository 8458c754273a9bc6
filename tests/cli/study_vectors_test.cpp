#include <filesystem>
#include <set>

#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;

class VectorStudy : public test::ProgramTest {
 protected:
  int study(Names more = {}) {
    more.insert(more.begin(), {"study", "--vectors", "--quick", "--size", "48x27"});
    return holdfast(more);
  }
};

TEST_F(VectorStudy, WritesTheDocumentedKeysTablesAndPictures) {
  ASSERT_EQ(
      study({"-o", path("study"), "--json", path("study.json"), "--markdown", path("table.md")}), 0)
      << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "study.json"));
  EXPECT_EQ(keys(json), (Names{"cases", "draws", "height", "seconds", "width"}));
  EXPECT_EQ(json["width"], 48);
  EXPECT_EQ(json["height"], 27);
  std::set<std::string> components;
  for (const auto& one : json["cases"]) {
    EXPECT_EQ(keys(one), (Names{"component", "effect", "image", "pairs", "roughness", "scene"}));
    const std::string component = one["component"];
    components.insert(component);
    EXPECT_EQ(one["roughness"].is_null(), component != "glossy");
    for (const char* region : {"effect", "image"}) {
      EXPECT_EQ(keys(one[region]), (Names{"pixels", "reference_rmse", "vectors"}));
      EXPECT_EQ(keys(one[region]["vectors"]),
                component == "glossy"     ? (Names{"relative", "specular", "stochastic", "surface"})
                : component == "indirect" ? (Names{"dual", "unchecked"})
                                          : (Names{"borrowed", "shadow", "surface"}));
      for (const auto& figures : one[region]["vectors"])
        EXPECT_EQ(keys(figures),
                  (Names{"rmse_fallback", "rmse_mean", "rmse_valid", "share_valid"}));
    }
  }
  EXPECT_EQ(components, (std::set<std::string>{"glossy", "indirect", "light0.visibility"}));
  EXPECT_EQ(json["seconds"].size(), json["cases"].size());
  const std::string table = test::file_text(dir / "table.md");
  for (const char* part :
       {"| scene | roughness | surface | specular | stochastic | relative |",
        "| scene | surface | shadow | borrowed |", "| scene | unchecked | dual |",
        "| moving camera | 0.10 |", "| fence |", "**"})
    EXPECT_NE(table.find(part), table.npos) << part;
  for (const char* name : {"glossy.moving-objects.roughness-0.50.png",
                           "light0.visibility.fence.png", "indirect.occluder.png"})
    EXPECT_TRUE(std::filesystem::exists(dir / "study" / name)) << name;
}

TEST_F(VectorStudy, AMirrorIsBetterFollowedByItsImageThanByItsSurface) {
  ASSERT_EQ(study({"--json", path("study.json"), "--quiet"}), 0) << text;
  EXPECT_EQ(text.find("glossy, where the effect moves"), 0u) << "tables are printed: " << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "study.json"));
  const auto& mirror = json["cases"][0];
  EXPECT_EQ(mirror["roughness"], 0.0);
  EXPECT_EQ(mirror["effect"]["reference_rmse"], 0.0) << "the scene has no noise but the lobe's";
  const auto& vectors = mirror["effect"]["vectors"];
  for (const char* image : {"specular", "stochastic", "relative"})
    EXPECT_LT(vectors[image]["rmse_valid"], 0.9 * vectors["surface"]["rmse_valid"].get<double>());
}

TEST_F(VectorStudy, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(study({"--scenes", "fence"}), 2) << "an option of --quality";
  EXPECT_EQ(study({"--quality"}), 2) << "one study at a time";
  EXPECT_EQ(study({"--size", "0x9"}), 2);
  EXPECT_EQ(holdfast({"study", "--quality", "--quick", "-o", path("study")}), 2);
  EXPECT_EQ(holdfast({"study", "--quality"}), 2) << "without a folder";
  EXPECT_NE(text.find("--output"), text.npos) << text;
}

}  // namespace
}  // namespace holdfast
