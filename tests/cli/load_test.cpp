#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

/// `holdfast load` on small frames, against a server in its own process unless told otherwise.
class Load : public test::ProgramTest {
 protected:
  nlohmann::json load(std::vector<std::string> more, const char* size = "48x32") {
    more.insert(more.begin(), {"load", "--size", size, "--seconds", "0.5", "--threads", "1",
                               "--json", path("load.json")});
    EXPECT_EQ(holdfast(more), 0) << text;
    return nlohmann::json::parse(test::file_text(dir / "load.json"), nullptr, false);
  }
};

TEST_F(Load, SendsAsManyFramesAsItsRateSaysWhenTheServerKeepsUp) {
  const auto json = load({"--fps", "20", "--sessions", "2"});
  EXPECT_EQ(json["submitted"], 20);
  EXPECT_EQ(json["answered"], 20);
  EXPECT_TRUE(json["errors"].empty());
}

TEST_F(Load, SplitsTheLatencyOfEachFrameIntoItsParts) {
  const auto json = load({"--fps", "20"});
  const auto& ms = json["ms"];
  EXPECT_EQ(test::keys(ms),
            (std::vector<std::string>{"client", "filter", "latency", "queue", "transport"}));
  double parts = 0;
  for (const char* part : {"client", "queue", "filter", "transport"}) {
    EXPECT_LE(ms[part]["p50"], ms[part]["max"]) << part;
    EXPECT_LE(ms[part]["max"], ms["latency"]["max"]) << part;
    parts += ms[part]["max"].get<double>();
  }
  EXPECT_GE(parts * 1.001, ms["latency"]["max"].get<double>());
}

TEST_F(Load, CountsLatencyFromThePlannedTimeWhenTheServerDoesNotKeepUp) {
  // More frames in half a second than one thread can filter.
  const auto json = load({"--fps", "400"}, "240x180");
  EXPECT_EQ(json["submitted"], 200);
  EXPECT_GT(json["ms"]["client"]["max"].get<double>(), 500.0) << "the backlog is not hidden";
}

TEST_F(Load, KeepsTheServerBusyInAClosedLoop) {
  const auto json = load({});
  EXPECT_GT(json["answered"], 3);
  EXPECT_EQ(json["ms"]["client"]["max"], 0.0);
}

TEST_F(Load, SaysThatAServerIsNotThere) {
  EXPECT_EQ(holdfast({"load", "--server", "127.0.0.1:1", "--seconds", "1", "--size", "8x8"}), 3);
  EXPECT_NE(text.find("cannot be reached"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast
