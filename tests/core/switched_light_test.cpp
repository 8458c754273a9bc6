#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"

namespace holdfast {
namespace {

using test::filtered;

constexpr int kWidth = 64, kHeight = 48, kSwitch = 12;

/// A wall that stands still under a light with a penumbra and indirect light; both change at
/// frame kSwitch, though nothing moves.
struct SwitchedLight {
  DenoiserConfig config;
  Denoiser denoiser;
  bool switched;

  explicit SwitchedLight(const std::string& recipe, bool does_switch = true)
      : config(config_of(recipe)), denoiser(config), switched(does_switch) {}

  static DenoiserConfig config_of(const std::string& recipe) {
    DenoiserConfig config = test::shadow_config(kWidth, kHeight);
    config.planes.push_back(test::kIndirectPlane);
    config.recipe = recipe;
    return config;
  }
  double visibility(int index, int x) const {
    const double penumbra = std::clamp(x / double(kWidth), 0.0, 1.0);
    return switched && index >= kSwitch ? 1.0 : penumbra;
  }
  double indirect(int index) const { return switched && index >= kSwitch ? 0.7 : 1.0; }

  Frame frame(int index) const {
    Frame frame = test::noisy_frame(config, 0);
    frame.index = index;
    test::Random random(900u + static_cast<std::uint32_t>(index));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool lit = random.uniform() < visibility(index, x);
        const auto set = [&](PlaneId id, int c, float v) {
          frame.planes.find(id)->channel(c).at(x, y) = v;
        };
        set(test::of_light(PlaneKind::kVisibility), 0, lit ? 1.0f : 0.0f);
        set(test::of_light(PlaneKind::kBlockerDistance), 0, lit ? test::kInf : 1.0f);
        set(test::kDepthPlane, 0, 5.0f);
        frame.planes.find(test::kIdPlane)->ids().at(x, y) = 1;
        const float sample = static_cast<float>(indirect(index)) * random.real(0, 2);
        for (int c = 0; c < 3; ++c) set(test::kIndirectPlane, c, sample);
      }
    return frame;
  }
  /// RMSE of a component in that frame.
  double error(const PlaneSet& results, PlaneId id, int index) const {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double truth =
            id.kind == PlaneKind::kIndirect ? indirect(index) : visibility(index, x);
        const double e = double(results.at(id).channel(0).at(x, y)) - truth;
        sum += e * e;
      }
    return std::sqrt(sum / (kWidth * kHeight));
  }
};

TEST(SwitchedLight, IsReportedForEachComponentWhenItHappensAndNotWhenItIsPast) {
  SwitchedLight world("reliable");
  PlaneSet results;
  for (int index = 0; index < kSwitch; ++index)
    EXPECT_TRUE(world.denoiser.filter(world.frame(index), results).changes.empty()) << index;
  const FrameReport report = world.denoiser.filter(world.frame(kSwitch), results);
  ASSERT_EQ(report.changes.size(), 2u);
  EXPECT_EQ(report.changes[0].component.kind, ComponentKind::kVisibility);
  EXPECT_EQ(report.changes[1].component.kind, ComponentKind::kIndirect);
  for (const NoticedChange& change : report.changes) EXPECT_GT(change.share, 0.5);
  EXPECT_FALSE(report.history_reset);
  for (int index = kSwitch + 1; index < kSwitch + 12; ++index) {
    const bool settled = world.denoiser.filter(world.frame(index), results).changes.empty();
    if (index > kSwitch + 5) EXPECT_TRUE(settled) << index;
  }
}

TEST(SwitchedLight, IsFollowedAtOnceRatherThanOverManyFrames) {
  SwitchedLight noticing("reliable"), blind("reliable-without-light-changes");
  const PlaneId shadow = test::of_light(PlaneKind::kVisibility);
  for (int index = 0; index <= kSwitch; ++index) {
    const Frame frame = noticing.frame(index);
    const PlaneSet a = filtered(noticing.denoiser, frame), b = filtered(blind.denoiser, frame);
    if (index < kSwitch) {
      EXPECT_TRUE(test::same_bits(a, b)) << index;
      continue;
    }
    for (const PlaneId id : {shadow, test::kIndirectPlane})
      EXPECT_LT(noticing.error(a, id, index), 0.5 * blind.error(b, id, index)) << plane_name(id);
  }
}

TEST(SwitchedLight, WithoutSwitchBothGiveTheSameBits) {
  SwitchedLight noticing("reliable", false), blind("reliable-without-light-changes", false);
  for (int index = 0; index < 20; ++index) {
    const Frame frame = noticing.frame(index);
    ASSERT_TRUE(
        test::same_bits(filtered(noticing.denoiser, frame), filtered(blind.denoiser, frame)))
        << index;
  }
}

}  // namespace
}  // namespace holdfast
