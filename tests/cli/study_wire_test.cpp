#include "client/sequence/sequence.h"
#include "tests/cli/program_test.h"
#include "tests/service/test_frames.h"

namespace holdfast {
namespace {

using test::keys;
using Names = std::vector<std::string>;

class StudyWire : public test::ProgramTest {
 protected:
  void SetUp() override {
    test::ProgramTest::SetUp();
    const DenoiserConfig config = test::small_config();
    SequenceWriter writer(dir / "in", {config.width, config.height, 30, config.lights, {}});
    for (int i = 0; i < 3; ++i) writer.write_frame(test::small_frame(config, i));
    writer.finish();
  }
};

TEST_F(StudyWire, GivesBytesTimesAndErrorsOfEveryProfile) {
  ASSERT_EQ(holdfast({"study", "--wire", path("in"), "--quiet", "--json", path("wire.json"),
                      "--markdown", path("wire.md")}),
            0)
      << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "wire.json"));
  ASSERT_EQ(json["wire"].size(), 3u);
  const auto &exact = json["wire"][0], &balanced = json["wire"][1], &compact = json["wire"][2];
  for (const auto& row : json["wire"]) {
    EXPECT_EQ(keys(row),
              (Names{"down", "layers", "planes_down", "planes_up", "profile", "sequence", "up"}));
    for (const char* direction : {"up", "down"}) {
      EXPECT_GT(row[direction]["encode_ns_per_pixel"], 0.0);
      EXPECT_GT(row[direction]["decode_ns_per_pixel"], 0.0);
      EXPECT_LE(row[direction]["bytes_per_pixel"], row[direction]["plain_bytes_per_pixel"]);
    }
    EXPECT_TRUE(row["layers"]["composite"]["reference_rmse"].is_null()) << "no references";
  }
  EXPECT_EQ(exact["profile"], "exact");
  EXPECT_EQ(exact["up"]["bytes_per_pixel"], 36.0);
  EXPECT_EQ(exact["down"]["bytes_per_pixel"], 16.0);
  EXPECT_EQ(exact["layers"]["composite"]["rmse"], 0.0);
  EXPECT_EQ(compact["planes_up"]["objectId"]["plain_bytes_per_pixel"], 1.0);
  EXPECT_EQ(compact["planes_down"]["composite"]["plain_bytes_per_pixel"], 4.0);
  EXPECT_LT(balanced["up"]["bytes_per_pixel"], 18.0);
  EXPECT_GT(balanced["layers"]["composite"]["psnr"], 60.0);
  EXPECT_GT(compact["layers"]["composite"]["psnr"], 45.0);
  const std::string table = test::file_text(dir / "wire.md");
  for (const char* part :
       {"`exact`", "`balanced`", "`compact`", "| light0.unshadowed |", "| composite, result |"})
    EXPECT_NE(table.find(part), std::string::npos) << part;
}

TEST_F(StudyWire, NamesASequenceThatIsNotThere) {
  EXPECT_EQ(holdfast({"study", "--wire", path("nowhere"), "--quiet"}), 2);
  EXPECT_NE(text.find("nowhere"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast
