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
  // Several times what one thread can filter: the last frame, planned at 299 / 600 s, is late by
  // all that the others took more than half a second.
  const auto json = load({"--fps", "600"}, "240x180");
  EXPECT_EQ(json["submitted"], 300);
  const double behind_ms = 1e3 * (json["elapsed_s"].get<double>() - 299.0 / 600);
  ASSERT_GT(behind_ms, 50.0);
  EXPECT_NEAR(json["ms"]["latency"]["max"].get<double>(), behind_ms, 0.1 * behind_ms + 20);
  EXPECT_GT(json["ms"]["client"]["max"].get<double>(), 0.5 * behind_ms) << "it waited its turn";
}

TEST_F(Load, KeepsTheServerBusyInAClosedLoop) {
  const auto json = load({});
  EXPECT_GT(json["answered"], 3);
  EXPECT_EQ(json["ms"]["client"]["max"], 0.0);
}

TEST_F(Load, AddsALinkBetweenClientsAndServer) {
  const auto plain = load({"--fps", "8"});
  const auto slow = load({"--fps", "8", "--delay-ms", "30", "--bandwidth-mbit", "50"});
  EXPECT_EQ(slow["answered"], 4);
  EXPECT_EQ(slow["delay_ms"], 30.0);
  // One way for the frame, one for its answer, and 50 Mbit/s for 48 x 32 x 13 words.
  EXPECT_GE(slow["ms"]["latency"]["p50"], 60.0);
  EXPECT_GE(slow["ms"]["transport"]["p50"], plain["ms"]["transport"]["p50"].get<double>() + 50);
}

// Of several times the frames that one thread can filter, those that are sent are answered in time,
// and each of the others is counted by name.
TEST_F(Load, LeavesOutWhatAGameWouldWhenTheServerDoesNotKeepUp) {
  const auto json = load({"--fps", "600", "--latest", "--deadline-ms", "50"}, "240x180");
  const auto count = [&](const char* name) { return json[name].get<int>(); };
  EXPECT_EQ(count("submitted") + count("skipped"), 300);
  EXPECT_EQ(count("answered") + count("dropped"), count("submitted"));
  EXPECT_GT(count("skipped") + count("dropped"), 0);
  EXPECT_TRUE(json["errors"].empty());
}

TEST_F(Load, LetsClientsComeAndGo) {
  const auto json = load({"--fps", "20", "--sessions", "2", "--churn-s", "0.15"});
  EXPECT_GE(json["clients"], 6) << "each came back after 0.15 s of 0.5";
  EXPECT_EQ(json["answered"], json["submitted"]);
  EXPECT_GE(json["submitted"], 12);
  EXPECT_TRUE(json["errors"].empty());
}

TEST_F(Load, GivesSessionsTheirSizesInTurn) {
  const auto json = load({"--fps", "8", "--sessions", "3", "--size", "24x16"});
  EXPECT_EQ(json["sizes"], "48x32,24x16");
  EXPECT_EQ(json["answered"], 12);
  const auto small = load({"--fps", "8", "--sessions", "3"}, "24x16");
  // Two of 48x32 and one of 24x16, against three of these.
  EXPECT_EQ(json["bytes_in"].get<double>() / small["bytes_in"].get<double>(), 9.0 / 3.0);
}

TEST_F(Load, WritesAPageWithItsFiguresByItself) {
  const auto json = load({"--fps", "20", "--html", path("load.html")});
  const std::string page = test::file_text(dir / "load.html");
  EXPECT_NE(page.find("answered 10 of 10 frames"), std::string::npos);
  EXPECT_NE(page.find("class=\"line p95\""), std::string::npos);
  std::size_t frames = 0;
  for (std::size_t at = 0; (at = page.find("<title>", at + 1)) != std::string::npos;)
    if (page.compare(at + 7, 2, "p5") != 0 && std::isdigit(page[at + 7]))
      frames += std::stoul(page.substr(at + 7));
  EXPECT_EQ(frames, 10u) << "each is in a bar of the histogram";
  EXPECT_EQ(page.find("src="), std::string::npos) << "nothing from elsewhere";
  EXPECT_EQ(page.find("href="), std::string::npos);
}

TEST_F(Load, GoesOnWithThoseThatAreAdmittedEvenlySpacedAndCountsTheOthersOnce) {
  test::Program server({HOLDFAST_SERVER_PROGRAM, "--listen", "127.0.0.1:0", "--threads", "1",
                        "--max-sessions", "2", "--max-load", "0.5"},
                       dir / "server");
  ASSERT_TRUE(server.wait_for("event=listening")) << server.text();
  const std::string address = server.printed("address=");
  const std::vector<std::string> common{"load",      "--server", address,        "--size",
                                        "16x12",     "--json",   path("j.json"), "--tell-rate",
                                        "--seconds", "0.5125",   "--sessions",   "5"};
  std::vector<std::string> slow = common, fast = common;
  slow.insert(slow.end(), {"--fps", "20"});
  ASSERT_EQ(holdfast(slow), 0) << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "j.json"), nullptr, false);
  // 10.25 periods: a session that begins half a period later has no time for the eleventh frame.
  EXPECT_EQ(json["answered"], 11 + 10) << "those admitted are spread over the period";
  EXPECT_EQ(json["errors"], nlohmann::json({{"refused", 3}}));
  fast.insert(fast.end(), {"--fps", "10000000"});
  EXPECT_EQ(holdfast(fast), 3);
  EXPECT_NE(text.find("the server allows 50 %"), std::string::npos) << text;
  EXPECT_EQ(holdfast(common), 2) << "there is no rate to tell";
}

TEST_F(Load, SaysThatAServerIsNotThere) {
  EXPECT_EQ(holdfast({"load", "--server", "127.0.0.1:1", "--seconds", "1", "--size", "8x8"}), 3);
  EXPECT_NE(text.find("cannot be reached"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast
