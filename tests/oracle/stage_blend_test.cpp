// What blends a frame with its history, each kernel by itself, against the oracle.

#include "core/frame/plane_size.h"
#include "core/motion/follow_block.h"
#include "core/oracle/candidates.h"
#include "core/oracle/exponential.h"
#include "tests/oracle/stage_twins.h"

namespace holdfast {
namespace {

using oracle::Image;

// Means of a few dozen floats of at most 1; a standard deviation of nearly equal values loses half
// of its digits.
constexpr double kBlended = 5e-5, kOfSigma = 1e-3;
// Of up to 64 samples; where they follow from an expected error they are ratios of small
// differences of such means.
constexpr double kOfSamples = 2e-3, kOfPromisedSamples = 0.1;

/// A frame, its history and where that is, twice.
struct Twins {
  int channels;
  Guides guides;
  oracle::Surfaces surfaces;
  SurfaceHistory surface;
  EffectHistory effect;
  oracle::Past surface_past, effect_past;
  Channels<float> noisy, antilag;
  ComponentHistory before, now;
  Image noisy_image, antilag_image;

  Twins(int width, int height, int signal_channels, HistoryExtras extras, std::uint32_t seed)
      : channels(signal_channels),
        surface(width, height),
        effect(width, height),
        surface_past(width, height),
        effect_past(width, height),
        noisy(width, height, signal_channels),
        antilag((width + 2) / 3, (height + 2) / 3, 1),
        before(width, height, signal_channels, extras),
        now(width, height, signal_channels, extras) {
    test::Random random(seed);
    guides = test::leaning_walls(width, height, random);
    surfaces = test::surfaces_of(guides);
    test::random_taps(guides, guides, random, surface.taps, surface_past);
    test::random_taps(guides, guides, random, effect.taps, effect_past);
    for (int c = 0; c < channels; ++c) test::fill_random(noisy[c], random, 0, 1);
    for (int c = 0; c < 2; ++c) {
      test::fill_random(surface.motion[c], random, -2, 2);
      test::fill_random(effect.motion[c], random, -2, 2);
    }
    test::fill_random(effect.motion[kMotionTrust], random, 0, 1);
    test::fill_random(effect.motion[kMotionSweep], random, 0, 0.2f);
    test::fill_random(antilag[0], random, 0, 1);
    test::fill_history(before, random, 1);
    surface_past.motion = test::image_of(surface.motion, 0, 2);
    effect_past.motion = test::image_of(effect.motion, 0, 2);
    effect_past.trust = test::image_of(effect.motion, kMotionTrust, 1);
    effect_past.sweep = test::image_of(effect.motion, kMotionSweep, 1);
    noisy_image = test::image_of(noisy, 0, channels);
    antilag_image = test::image_of(antilag, 0, 1);
  }

  HistorySources sources(bool with_effect, bool with_antilag = false) const {
    HistorySources out{&surface, with_effect ? &effect : nullptr, {}};
    if (with_antilag) out.antilag = antilag[0];
    return out;
  }
  oracle::Sources same_sources(bool with_effect, bool with_antilag = false) const {
    return {&surface_past, with_effect ? &effect_past : nullptr,
            with_antilag ? &antilag_image : nullptr};
  }
  void expect_same(const oracle::Blended& expected, double tolerance, double of_samples,
                   double share) const {
    test::expect_close(now.data, 0, expected.now.signal, tolerance, share, "signal");
    test::expect_close(now.data, channels, expected.now.samples, of_samples, share, "samples");
    if (now.has_moments())
      test::expect_close(now.data, channels + 1, expected.now.moments, kBlended, share, "moments");
  }
};

constexpr double kTips = 2e-3;  // of the pixels: two candidates that promise the same

/// Which neighbours an effect's window takes.
Channels<float> random_footprint(int width, int height) {
  test::Random random(5);
  Channels<float> out(width, height, 3);
  test::fill_random(out[0], random, 0.01f, 0.5f);
  test::fill_random(out[1], random, -0.009f, 0.009f);
  test::fill_random(out[2], random, 0.01f, 0.5f);
  return out;
}

TEST(StageOracle, AnExponentialMeanOfAnyKindAgreesOnEveryInstructionSet) {
  for (const auto& [width, height] : test::kStageSizes)
    for (const int channels : {1, 3})
      for (const Rectification kind : {Rectification::kNone, Rectification::kClamp,
                                       Rectification::kClampBox, Rectification::kClampFallback})
        for (const bool variant : {false, true}) {
          Twins twins(width, height, channels,
                      variant ? HistoryExtras::kMoments : HistoryExtras::kNone, 71);
          const AccumulationRule rule{.alpha = variant ? 0.05f : 0.2f, .rectification = kind};
          const oracle::Blended expected = oracle::blend_exponentially(
              twins.surfaces, twins.noisy_image, twins.same_sources(true, variant), rule,
              test::history_of(twins.before), variant);
          const bool by_sigma =
              kind == Rectification::kClamp || kind == Rectification::kClampFallback;
          test::on_every_isa_and_threads([&] {
            accumulate(twins.guides, twins.noisy, twins.sources(true, variant), rule, twins.before,
                       twins.now, nullptr);
            twins.expect_same(expected, by_sigma ? kOfSigma : kBlended, kOfSamples, 0);
          });
        }
}

TEST(StageOracle, VisibilityByExpectedErrorAgreesOnEveryInstructionSet) {
  for (const auto& [width, height] : test::kStageSizes)
    for (const bool with_footprint : {false, true})
      for (const bool with_effect : {false, true}) {
        Twins twins(width, height, 1, HistoryExtras::kNone, 72);
        test::Random random(6);
        Channels<float> variance(width, height, 1);
        test::fill_random(variance[0], random, 0.05f, 0.25f);
        const Channels<float> footprint = random_footprint(width, height);
        const Image same_footprint = test::image_of(footprint, 0, 3);
        ExpectedErrorRule rule;
        rule.change.noticed = with_footprint;
        for (int x = 0; x < width; x += 3)  // shadows of what has just appeared
          twins.effect.motion[kMotionSweep].at(x, height / 2) = kAppearedSweep;
        twins.effect_past.sweep = test::image_of(twins.effect.motion, kMotionSweep, 1);
        const oracle::Blended expected = oracle::blend_visibility(
            twins.surfaces, twins.noisy_image, twins.same_sources(with_effect),
            test::image_of(variance, 0, 1), with_footprint ? &same_footprint : nullptr, rule,
            test::history_of(twins.before));
        test::on_every_isa_and_threads([&] {
          BlendScratch scratch(width, height);
          WindowScratch window(width, height);
          blend_by_expected_error(twins.guides, twins.noisy, twins.sources(with_effect),
                                  std::as_const(variance)[0], with_footprint ? &footprint : nullptr,
                                  rule, twins.before, scratch, window, twins.now, nullptr);
          twins.expect_same(expected, kBlended, kOfPromisedSamples, kTips);
        });
      }
}

TEST(StageOracle, RadianceByExpectedErrorAgreesOnEveryInstructionSet) {
  for (const auto& [width, height] : test::kStageSizes)
    for (const bool at_rest : {false, true})
      for (const bool substitutes : {false, true}) {
        Twins twins(width, height, 3, HistoryExtras::kNone, 73);
        const Channels<float> footprint = random_footprint(width, height);
        const Image same_footprint = test::image_of(footprint, 0, 3);
        RadianceBlendRule rule;
        rule.effect_substitutes = substitutes;
        // Most tiles, groups of them and the frame differ by that much.
        rule.change = {.noticed = true,
                       .tile_deviations = 1.0f,
                       .frame_deviations = 0.3f,
                       .moving_deviations = 0.5f};
        const oracle::Blended expected = oracle::blend_radiance(
            twins.surfaces, twins.noisy_image, twins.same_sources(true),
            at_rest ? nullptr : &same_footprint, rule, at_rest, test::history_of(twins.before));
        test::on_every_isa_and_threads([&] {
          RadianceBlendScratch scratch(width, height, 2);
          WindowScratch window(width, height);
          blend_radiance(twins.guides, twins.noisy, twins.sources(true),
                         at_rest ? nullptr : &footprint, rule, at_rest, twins.before, scratch,
                         window, twins.now, nullptr);
          twins.expect_same(expected, kBlended, kOfPromisedSamples, kTips);
        });
      }
}

}  // namespace
}  // namespace holdfast
