#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "server/calibration.h"
#include "server/session_table.h"
#include "tests/core/expect_input_error.h"
#include "tests/sanitizers.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using test::small_config;
using test::small_frame;

/// The session's answers under a budget, one frame after the other.
/// As holdfast-server does: costs are measured before the first session asks for a budget.
server::ServerConfig calibrated(int threads) {
  server::ServerConfig config = test::server_config(threads);
  config.calibrate = true;
  return config;
}

std::vector<client::FrameOutput> answers(const server::Server& server, const DenoiserConfig& config,
                                         double budget_ms, int frames) {
  client::SessionOptions options = test::session_options(server, config);
  options.budget_ms = budget_ms;
  client::Session session(options);
  std::vector<client::FrameOutput> outputs;
  for (int index = 0; index < frames; ++index) {
    session.submit(std::make_shared<const Frame>(small_frame(config, index)));
    outputs.push_back(*session.receive());
    EXPECT_FALSE(outputs.back().error) << outputs.back().error->message;
  }
  session.close();
  return outputs;
}

TEST(Budget, ATinyOneGivesTheFastestPresetAndALargeOneThePresetAskedFor) {
  const server::Server server(calibrated(1));
  for (const std::string& asked : kernel_preset_names()) {
    DenoiserConfig config = small_config();
    config.preset = asked;
    for (const client::FrameOutput& output : answers(server, config, 1e-6, 5))
      EXPECT_EQ(output.preset, "fast") << "asked for " << asked;
    for (const client::FrameOutput& output : answers(server, config, 1e6, 5))
      EXPECT_EQ(output.preset, asked);
  }
}

TEST(Budget, IsRefusedWithPresetReference) {
  const server::Server server(calibrated(1));
  DenoiserConfig config = small_config();
  config.preset = "reference";
  test::expect_input_error([&] { answers(server, config, 10, 1); }, "budget",
                           "must be 0 with preset reference", "10");
}

TEST(Budget, TheFastestPresetGivesTheBitsOfTheCoreWithThatPreset) {
  const server::Server server(calibrated(2));
  DenoiserConfig config = small_config();
  const auto outputs = answers(server, config, 1e-6, 4);
  config.preset = "fast";
  Denoiser denoiser(config);
  for (int index = 0; index < 4; ++index) {
    PlaneSet results;
    denoiser.filter(small_frame(config, index), results);
    EXPECT_TRUE(test::same_bits(results, outputs[static_cast<std::size_t>(index)].planes)) << index;
  }
}

// On one thread, each frame of the other session is a wait of far more than the budget, which is
// far more than a frame of this one takes.
TEST(Budget, ThePresetFallsUnderTheLoadOfAnotherSessionAndRisesAfterwards) {
  const server::Server server(calibrated(1));
  DenoiserConfig config = small_config(64, 36);
  config.preset = "accurate";
  client::SessionOptions options = test::session_options(server, config);
  options.budget_ms = test::kThreadSanitized ? 400 : 60;
  client::Session session(options);
  int index = 0;
  const auto next_preset = [&] {
    session.submit(std::make_shared<const Frame>(small_frame(config, index++)));
    return session.receive()->preset;
  };
  /// Whether a frame is filtered with it within a minute.
  const auto comes_to = [&](const std::string& preset) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (next_preset() != preset)
      if (std::chrono::steady_clock::now() > end) return false;
    return true;
  };
  EXPECT_TRUE(comes_to("accurate"));
  std::atomic<bool> busy{true};
  std::thread other([&] {
    const DenoiserConfig large =
        test::kThreadSanitized ? small_config(320, 180) : small_config(1280, 720);
    client::Session load(test::session_options(server, large));
    for (int i = 0; busy; ++i) {
      const auto frame = std::make_shared<const Frame>(small_frame(large, i));
      while (!load.try_submit(frame)) load.receive();
    }
    load.close();
  });
  EXPECT_TRUE(comes_to("fast"));
  busy = false;
  other.join();
  EXPECT_TRUE(comes_to("balanced")) << "one step at a time";
  EXPECT_TRUE(comes_to("accurate"));
  session.close();
}

// The least of several measurements: what else runs on the machine only adds.
TEST(Budget, CalibrationFindsTheFastestPresetTheCheapest) {
  constexpr double kUnknown = 1e30;
  double visibility[2] = {kUnknown, kUnknown}, radiance[2] = {kUnknown, kUnknown};
  const auto found = [&] { return radiance[0] < radiance[1] && visibility[0] < visibility[1]; };
  for (int run = 0; run < 40 && !found(); ++run) {
    const server::CostTable table = server::calibrate();
    ASSERT_EQ(table.size(), kernel_preset_names().size());
    for (const server::PresetCost& cost : table)
      for (const double part : {cost.frame, cost.visibility, cost.glossy, cost.indirect})
        EXPECT_GT(part, 0);
    for (std::size_t k = 0; k < 2; ++k) {
      visibility[k] = std::min(visibility[k], table[k].visibility);
      radiance[k] = std::min(radiance[k], table[k].glossy + table[k].indirect);
    }
  }
  EXPECT_LT(radiance[0], radiance[1]);
  EXPECT_LT(visibility[0], visibility[1]);
}

// A session is accounted for with the preset that it asks for: those it may fall back to need less.
TEST(Budget, FasterPresetsNeedNoMoreMemory) {
  DenoiserConfig config = small_config(320, 180);
  for (const PlaneKind kind :
       {PlaneKind::kRoughness, PlaneKind::kAlbedo, PlaneKind::kGlossy, PlaneKind::kGlossyDirection,
        PlaneKind::kGlossyHitDistance, PlaneKind::kIndirect, PlaneKind::kIndirectDirection})
    config.planes.push_back({kind, {}});
  std::vector<std::size_t> held, borrowed;
  for (const std::string& preset : kernel_preset_names()) {
    config.preset = preset;
    const Denoiser denoiser(config);
    held.push_back(denoiser.held_bytes());
    borrowed.push_back(denoiser.scratch_bytes());
  }
  EXPECT_TRUE(std::is_sorted(held.begin(), held.end()));
  EXPECT_TRUE(std::is_sorted(borrowed.begin(), borrowed.end()));
}

}  // namespace
}  // namespace holdfast
