#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/sequence/temp_dir.h"

// The build names the program under test; by hand, it is the one on the PATH.
#ifndef HOLDFAST_PROGRAM
#define HOLDFAST_PROGRAM "holdfast"
#endif

namespace holdfast::test {

/// Runs `holdfast` as a user does, in a folder of its own.
class ProgramTest : public ::testing::Test {
 protected:
  /// The exit code of `holdfast ARGUMENTS`, with what it printed in `text`.
  int holdfast(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), HOLDFAST_PROGRAM);
    Program program(arguments, dir / "log");
    const int code = program.wait();
    text = program.text();
    return code;
  }
  std::string path(const std::string& name) const { return (dir / name).string(); }

  /// Renders `scene` at 64x36 to the folder "in".
  void render(const std::string& scene, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "-o", path("in"), "--size", "64x36", "--quiet"});
    ASSERT_EQ(holdfast(more), 0) << text;
  }
  /// Replays "in" to the folder `out` and returns the result.
  nlohmann::json replay(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {"replay", path("in"), "-o", path(out), "--quiet", "--json", path("replay.json")});
    EXPECT_EQ(holdfast(more), 0) << text;
    return nlohmann::json::parse(file_text(dir / "replay.json"), nullptr, false);
  }
  /// Compares the folder `out` with the references of "in".
  nlohmann::json compare(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"compare", "--test", path(out), "--reference", path("in"), "--quiet",
                               "--json", path("compare.json")});
    EXPECT_EQ(holdfast(more), 0) << text;
    return nlohmann::json::parse(file_text(dir / "compare.json"), nullptr, false);
  }

  const TempDir dir;
  std::string text;
};

/// The names of a JSON object, in order.
inline std::vector<std::string> keys(const nlohmann::json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

}  // namespace holdfast::test
