#include <cmath>

#include "client/sequence/sequence.h"
#include "core/denoiser/denoiser.h"
#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;

class Study : public test::ProgramTest {
 protected:
  /// The exit code of a study of quality at 64x36 in the folder "study".
  int study(const std::string& scenes, Names more = {}) {
    more.insert(more.begin(),
                {"study", "--quality", "-o", path("study"), "--scenes", scenes, "--frames", "4",
                 "--size", "64x36", "--reference-spp", "16", "--json", path("study.json")});
    const int code = holdfast(more);
    json = nlohmann::json::parse(test::file_text(dir / "study.json"), nullptr, false);
    return code;
  }
  /// `holdfast compare` of a result of the study.
  nlohmann::json compared(const std::string& scene, const std::string& recipe,
                          const std::string& mask) {
    const std::string file = path("compare.json");
    EXPECT_EQ(holdfast({"compare", "--test", path("study/" + scene + "/" + recipe), "--reference",
                        path("study/" + scene + "/sequence"), "--mask", mask, "--json", file}),
              0)
        << text;
    return nlohmann::json::parse(test::file_text(file), nullptr, false);
  }

  nlohmann::json json;
};

TEST_F(Study, FiguresAreThoseOfCompareAndStandInPageJsonAndMarkdown) {
  ASSERT_EQ(study("fence,glossy-floor",
                  {"--recipes", "traditional,reliable", "--markdown", path("table.md")}),
            0)
      << text;
  EXPECT_EQ(keys(json), (Names{"claims", "scenes", "seconds"}));
  EXPECT_EQ(keys(json["scenes"]), (Names{"fence", "glossy-floor"}));
  for (const char* scene : {"fence", "glossy-floor"}) {
    const auto& out = json["scenes"][scene];
    EXPECT_EQ(keys(out), (Names{"caption", "recipes", "references"}));
    EXPECT_EQ(keys(out["recipes"]), (Names{"reliable", "traditional"}));
    for (const char* recipe : {"reliable", "traditional"}) {
      const auto& figures = out["recipes"][recipe];
      EXPECT_EQ(keys(figures), (Names{"core_ms_p50", "core_over_traditional", "effect", "image"}));
      EXPECT_GT(figures["core_ms_p50"], 0.0);
      for (const char* mask : {"image", "effect"})
        EXPECT_EQ(figures[mask], compared(scene, recipe, mask)) << scene << recipe << mask;
    }
    EXPECT_EQ(out["recipes"]["traditional"]["core_over_traditional"], 1.0);
    for (const auto& [layer, noise] : out["references"].items()) {
      EXPECT_EQ(keys(noise), (Names{"effect", "image"})) << layer;
      EXPECT_EQ(keys(noise["image"]), (Names{"best_rmse", "reference_rmse", "sufficient"}));
      EXPECT_GT(noise["image"]["reference_rmse"], 0.0) << layer << ": seeds must differ";
      EXPECT_FALSE(noise["image"]["sufficient"]) << "16 samples are few";
    }
  }
  const std::string table = test::file_text(dir / "table.md");
  for (const char* part : {"| claim |", "| `fence` |", "| `glossy-floor` |", "| `reliable` |"})
    EXPECT_NE(table.find(part), table.npos) << part;
  const std::string page = test::file_text(dir / "study/report.html");
  EXPECT_NE(page.find("class=\"claims\""), page.npos);
  EXPECT_NE(page.find("src=\"png/fence.composite.reliable.png\""), page.npos);
  EXPECT_TRUE(std::filesystem::exists(dir / "study/png/fence.composite.reliable.png"));
}

TEST_F(Study, ClaimsAreTheRatiosOfItsFigures) {
  ASSERT_EQ(study("fence", {"--recipes", "clamp,reliable", "--no-flip", "--quiet"}), 0) << text;
  EXPECT_EQ(text.find("| claim |"), 0u) << "tables are printed: " << text;
  const auto rmse = [&](const char* recipe) {
    return json["scenes"]["fence"]["recipes"][recipe]["effect"]["layers"]["light0.visibility"]
               ["rmse"]
                   .get<double>();
  };
  const auto& claim = json["claims"][0];
  EXPECT_EQ(keys(claim), (Names{"against", "bar", "effect", "layer", "mask", "metric", "pass",
                                "reference_limited", "relation", "scene", "value"}));
  EXPECT_EQ(claim["effect"], "shadows");
  EXPECT_EQ(claim["against"], "clamp");
  EXPECT_DOUBLE_EQ(claim["value"].get<double>(), rmse("reliable") / rmse("clamp"));
  EXPECT_EQ(claim["pass"], claim["value"] <= 0.84);
  EXPECT_TRUE(json["claims"][1]["pass"].is_null()) << "svgf was not run";
}

TEST_F(Study, RunsEveryRecipeUnlessToldOtherwise) {
  ASSERT_EQ(study("cylinder", {"--no-flip", "--quiet"}), 0) << text;
  for (const std::string& recipe : recipe_names())
    EXPECT_TRUE(json["scenes"]["cylinder"]["recipes"].contains(recipe)) << recipe;
}

TEST_F(Study, ReuseKeepsSequencesOfTheSameSettingsAndRefusesOthers) {
  const Names recipes{"--recipes", "spatial", "--no-flip", "--quiet", "--reuse"};
  ASSERT_EQ(study("fence", recipes), 0) << text;
  const auto first = json;
  const auto frame = sequence_file(dir / "study/fence/sequence", "frame", 3);
  const auto written = std::filesystem::last_write_time(frame);
  ASSERT_EQ(study("fence", recipes), 0) << text;
  EXPECT_EQ(std::filesystem::last_write_time(frame), written);
  EXPECT_EQ(json["scenes"]["fence"]["references"], first["scenes"]["fence"]["references"]);

  Names faster = recipes;
  faster.insert(faster.end(), {"--speed", "2"});
  EXPECT_EQ(study("fence", faster), 2);
  EXPECT_NE(text.find("speed must be 2.0 to be reused"), text.npos) << text;
  faster.erase(std::find(faster.begin(), faster.end(), "--reuse"));
  EXPECT_EQ(study("fence", faster), 0) << text;
  EXPECT_GT(std::filesystem::last_write_time(frame), written);
}

TEST_F(Study, JudgesACutFromTheFramesOfItsEvents) {
  ASSERT_EQ(study("cut", {"--recipes", "spatial", "--no-flip", "--quiet", "--speed", "3"}), 0)
      << text;
  const SequenceReader sequence(dir / "study/cut/sequence");
  EXPECT_EQ(sequence.frame_indices().front(), 17);
  EXPECT_EQ(sequence.frame_indices().back(), 119);
  for (const std::int64_t event : {30, 60, 90}) {
    EXPECT_FALSE(sequence.has_reference(event - 1));
    EXPECT_TRUE(sequence.has_reference(event) && sequence.has_reference(event + 1));
    EXPECT_EQ(sequence.read_frame(event).cut, event == 30) << "at its own speed";
  }
}

TEST_F(Study, RefusesUnknownRecipesAndScenesBeforeItRenders) {
  EXPECT_EQ(study("fence", {"--recipes", "reliable,wrong"}), 2);
  EXPECT_NE(text.find("'wrong'"), text.npos) << text;
  EXPECT_EQ(study("fence,nowhere"), 2);
  EXPECT_NE(text.find("nowhere"), text.npos) << text;
  EXPECT_FALSE(std::filesystem::exists(dir / "study"));
  EXPECT_EQ(holdfast({"study", "-o", path("study")}), 2) << "what to study is not said";
}

}  // namespace
}  // namespace holdfast
