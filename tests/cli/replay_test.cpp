#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/sequence/sequence.h"
#include "tests/cli/run_program.h"
#include "tests/sanitizers.h"
#include "tests/service/test_frames.h"

namespace holdfast {
namespace {

namespace fs = std::filesystem;

/// A sequence of four small frames numbered from 3, and a place for results.
class Replay : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "holdfast-replay-XXXXXX").string();
    dir = mkdtemp(pattern.data());
    SequenceWriter writer(dir / "in", {config.width, config.height, 30, config.lights, {}});
    for (int i = 3; i < 7; ++i) writer.write_frame(test::small_frame(config, i));
    writer.finish();
  }
  void TearDown() override { fs::remove_all(dir); }

  /// Runs `holdfast replay` on the sequence; its exit code, with its output in `text`.
  int replay(const std::vector<std::string>& more) {
    std::vector<std::string> command{HOLDFAST_PROGRAM, "replay", (dir / "in").string(), "-o",
                                     (dir / "out").string()};
    command.insert(command.end(), more.begin(), more.end());
    test::Program program(command, dir / "log");
    const int code = program.wait();
    text = program.text();
    return code;
  }
  bool said(const std::string& part) const { return text.find(part) != std::string::npos; }

  /// The results on disk are those of the core called directly.
  void expect_results(int first, int last) {
    Denoiser denoiser(config);
    for (int i = first; i <= last; ++i) {
      PlaneSet expected;
      denoiser.filter(test::small_frame(config, i), expected);
      EXPECT_TRUE(test::same_bits(read_exr(sequence_file(dir / "out", "frame", i)), expected))
          << "frame " << i;
    }
  }

  const DenoiserConfig config = test::small_config();
  fs::path dir;
  std::string text;
};

/// A server program on a socket of its own.
class ServerProgram {
 public:
  ServerProgram(const fs::path& dir, const std::vector<std::string>& more = {})
      : address("unix:" + (dir / "s").string()), program(command(address, more), dir / "server") {
    EXPECT_TRUE(program.wait_for("event=listening")) << program.text();
  }
  static std::vector<std::string> command(const std::string& address,
                                          const std::vector<std::string>& more) {
    std::vector<std::string> out{HOLDFAST_SERVER_PROGRAM, "--listen", address};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  const std::string address;
  test::Program program;
};

TEST_F(Replay, WritesTheBitsOfTheCoreCalledDirectlyForOneAndTwoThreads) {
  for (const char* threads : {"1", "2"}) {
    ASSERT_EQ(replay({"--quiet", "--threads", threads}), 0) << text;
    EXPECT_EQ(text, "") << "quiet";
    expect_results(3, 6);
    fs::remove_all(dir / "out");
  }
}

TEST_F(Replay, WritesItsResultAsJsonWithTheKeysOfTheFormat) {
  if (test::kThreadSanitized) GTEST_SKIP() << "costs are not measured before clients give up";
  ASSERT_EQ(replay({"--json", (dir / "result.json").string(), "--budget-ms", "40000"}), 0) << text;
  const auto json = nlohmann::json::parse(test::file_text(dir / "result.json"));
  EXPECT_EQ(json["frames"], 4);
  EXPECT_EQ(json["recipe"], "reliable");
  EXPECT_EQ(json["preset"], "balanced");
  EXPECT_EQ(json["presets"], (nlohmann::json{{"balanced", 4}}));
  EXPECT_EQ(json["width"], config.width);
  EXPECT_EQ(json["height"], config.height);
  EXPECT_EQ(json["bytes_in"], 4 * config.width * config.height * 4 * 9);
  EXPECT_EQ(json["bytes_out"], 4 * config.width * config.height * 4 * 4);
  EXPECT_EQ(json["non_finite_in"], 0);
  EXPECT_EQ(json["non_finite_out"], 0);
  for (const char* time : {"core", "total"})
    for (const char* percentile : {"p50", "p95", "p99"})
      EXPECT_TRUE(json["ms"][time][percentile].is_number()) << time << percentile;
  EXPECT_EQ(json.size(), 11u);
}

TEST_F(Replay, CountsTheBytesThatCrossTheWireUnderEveryProfile) {
  const auto bytes = [&](const std::string& wire) {
    EXPECT_EQ(replay({"--json", (dir / "result.json").string(), "--wire", wire}), 0) << text;
    const auto json = nlohmann::json::parse(test::file_text(dir / "result.json"));
    return std::pair(json["bytes_in"].get<int>(), json["bytes_out"].get<int>());
  };
  const auto exact = bytes("exact");
  expect_results(3, 6);
  const auto balanced = bytes("balanced"), compact = bytes("compact");
  EXPECT_EQ(exact.first, 4 * config.width * config.height * 4 * 9);
  EXPECT_LT(balanced.first, exact.first / 2);
  EXPECT_LT(compact.first, balanced.first);
  EXPECT_LT(balanced.second, exact.second);
  EXPECT_LT(compact.second, balanced.second);
}

TEST_F(Replay, WritesOnlyTheFramesAndLayersAskedFor) {
  ASSERT_EQ(replay({"--frames", "4-5", "--layers", "light0.visibility"}), 0) << text;
  EXPECT_FALSE(fs::exists(sequence_file(dir / "out", "frame", 3)));
  EXPECT_FALSE(fs::exists(sequence_file(dir / "out", "frame", 6)));
  const PlaneSet planes = read_exr(sequence_file(dir / "out", "frame", 5));
  EXPECT_EQ(planes.size(), 1u);
  EXPECT_TRUE(planes.find(PlaneId::of_light(PlaneKind::kVisibility, 0)));
}

TEST_F(Replay, GoesThroughAServerProgramWhichStopsOnSigterm) {
  ServerProgram server(dir);
  ASSERT_EQ(replay({"--server", server.address}), 0) << text;
  expect_results(3, 6);
  server.program.kill(SIGTERM);
  EXPECT_EQ(server.program.wait(), 0);
  EXPECT_NE(server.program.text().find("event=stopped"), std::string::npos);
  EXPECT_FALSE(fs::exists(dir / "s"));
}

TEST_F(Replay, EndsWithThreeWhenTheServerIsNotThereOrRefusesOrStops) {
  EXPECT_EQ(replay({"--server", "127.0.0.1:1"}), 3);
  EXPECT_TRUE(said("server 127.0.0.1:1 cannot be reached")) << text;

  ServerProgram small(dir, {"--max-session-bytes", "1000"});
  EXPECT_EQ(replay({"--server", small.address}), 3);
  EXPECT_TRUE(said("one session may have")) << text;
}

TEST_F(Replay, EndsWithThreeWhenTheServerStopsInTheMiddle) {
  ServerProgram server(dir);
  std::thread stop([&] {  // after a frame: a stream that has just begun may break unanswered
    for (int i = 0; i < 6000 && !fs::exists(sequence_file(dir / "out", "frame", 3)); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    server.program.kill(SIGTERM);
  });
  EXPECT_EQ(replay({"--server", server.address, "--fps", "2", "--reconnect-ms", "0"}), 3);
  stop.join();
  EXPECT_TRUE(said("the server is shutting down")) << text;
  EXPECT_EQ(server.program.wait(), 0);
}

TEST_F(Replay, GoesOnWithTheServerThatTakesThePlaceOfTheLostOne) {
  auto server = std::make_unique<ServerProgram>(dir);
  const std::string address = server->address;
  std::thread restart([&] {
    server->program.wait_for("event=stream_open");
    server->program.kill(SIGKILL);
    server->program.wait();
    server = std::make_unique<ServerProgram>(dir);
  });
  EXPECT_EQ(replay({"--server", address, "--fps", "4"}), 0) << text;
  restart.join();
  for (int i = 3; i < 7; ++i)
    EXPECT_TRUE(fs::exists(sequence_file(dir / "out", "frame", i))) << "frame " << i;
}

TEST_F(Replay, EndsWithTwoAndNamesAWrongArgument) {
  EXPECT_EQ(replay({"--recipe", "magic"}), 2);
  EXPECT_TRUE(
      said("recipe must be one of spatial, traditional, clamp, clamp-box, specular, "
           "specular-clamp, svgf, asvgf, paper, "
           "paper-adaptive, reliable, but it is \"magic\""))
      << text;
  EXPECT_EQ(replay({"--preset", "x"}), 2);
  EXPECT_TRUE(said("preset must be one of")) << text;
  EXPECT_EQ(replay({"--indirect-basis", "sh"}), 2);
  EXPECT_TRUE(said("indirect basis must be one of irradiance, luminance-cones, cones")) << text;
  EXPECT_EQ(replay({"--half-resolution", "indirect,shadow"}), 2);
  EXPECT_TRUE(said("half resolution must be of indirect, glossy, visibility or none")) << text;
  EXPECT_EQ(replay({"--wire", "zip"}), 2);
  EXPECT_TRUE(said("wire must be one of exact, balanced, compact, but it is \"zip\"")) << text;
  EXPECT_EQ(replay({"--layers", "depth"}), 2);
  EXPECT_TRUE(said("result plane must be one of composite")) << text;
  EXPECT_EQ(replay({"--layers", "nothing"}), 2);
  EXPECT_TRUE(said("layer \"nothing\" must be a result plane")) << text;
  EXPECT_EQ(replay({"--frames", "9-3"}), 2);
  EXPECT_TRUE(said("--frames must be A-B with A <= B")) << text;
  EXPECT_EQ(replay({"--frames", "100"}), 2);
  EXPECT_TRUE(said("which are in 3..6")) << text;
  EXPECT_EQ(replay({"--budget-ms", "0"}), 2);
  EXPECT_EQ(replay({"--fps", "-1"}), 2);
  EXPECT_EQ(replay({"--no-such-option"}), 2);
}

TEST_F(Replay, EndsWithTwoAndNamesTheFileThatIsMissing) {
  fs::remove(sequence_file(dir / "in", "frame", 5));
  EXPECT_EQ(replay({}), 2);
  EXPECT_TRUE(said("frame.0005.exr")) << text;
  fs::remove_all(dir / "in");
  EXPECT_EQ(replay({}), 2);
  EXPECT_TRUE(said((dir / "in").string() + " must be an existing directory")) << text;
}

TEST_F(Replay, EndsWithOneWhenTheResultsCannotBeWritten) {
  std::ofstream(dir / "out") << "a file where the directory should be";
  EXPECT_EQ(replay({}), 1) << text;
}

TEST(ServerProgramAlone, EndsWithTwoWhenItsPortIsInUse) {
  std::string pattern = (fs::temp_directory_path() / "holdfast-port-XXXXXX").string();
  const fs::path dir = mkdtemp(pattern.data());
  {
    ServerProgram first(dir);
    test::Program second({HOLDFAST_SERVER_PROGRAM, "--listen", first.address}, dir / "second");
    EXPECT_EQ(second.wait(), 2);
    EXPECT_NE(second.text().find("must be free, but it is in use"), std::string::npos);
    first.program.kill(SIGINT);
    EXPECT_EQ(first.program.wait(), 0);
  }
  fs::remove_all(dir);
}

TEST(ServerProgramAlone, EndsWithTwoAndNamesAWrongArgument) {
  const fs::path log = fs::temp_directory_path() / ("holdfast-log-" + std::to_string(getpid()));
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{HOLDFAST_SERVER_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return test::Program(command, log).wait();
  };
  EXPECT_EQ(run({"--listen", "nonsense"}), 2);
  EXPECT_NE(test::file_text(log).find("must be host:port or unix:PATH"), std::string::npos);
  EXPECT_EQ(run({"--log-level", "loud"}), 2);
  EXPECT_EQ(run({"--threads", "-1"}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_NE(test::file_text(log).find("--max-sessions"), std::string::npos);
  fs::remove(log);
}

}  // namespace
}  // namespace holdfast
