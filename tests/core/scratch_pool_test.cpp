// Scratch that denoisers share: what it holds when it is lent must show in no result.

#include "core/denoiser/scratch_pool.h"

#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "core/frame/plane_size.h"
#include "tests/core/preset_world.h"
#include "tests/core/rest_world.h"
#include "tests/sanitizers.h"

namespace holdfast {
namespace {

using test::config_of;
using Pool = std::shared_ptr<ScratchPool>;

/// Fills the block that will be lent next. 0xff: every float is NaN, every place far outside; 0x7e:
/// every float is 8.4e37; 0: what a new block usually holds.
void spoil(ScratchPool& pool, int byte) {
  const ScratchPool::Loan loan = pool.borrow(pool.largest());
  std::memset(loan.data(), byte, loan.bytes());
}

TEST(ScratchPool, LendsTheSameBlockAgainAndAnotherOneWhileItIsOut) {
  ScratchPool pool;
  pool.enter(1000);
  std::byte* first = nullptr;
  {
    const ScratchPool::Loan one = pool.borrow(1000), two = pool.borrow(10);
    first = one.data();
    EXPECT_NE(two.data(), first);
    EXPECT_EQ(two.bytes(), 1000u) << "any block serves any denoiser";
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(one.data()) % 64, 0u);
  }
  EXPECT_EQ(pool.bytes(), 2000u);
  EXPECT_EQ(pool.borrow(1000).data(), first) << "it was given back last";
  EXPECT_EQ(pool.bytes(), 2000u);
}

TEST(ScratchPool, HoldsNoMoreThanTheNeediestNeedsForEachFrameAtOnce) {
  ScratchPool pool;
  pool.enter(1000);
  { const ScratchPool::Loan one = pool.borrow(1000), two = pool.borrow(1000); }
  pool.enter(5000);
  EXPECT_EQ(pool.largest(), 5000u);
  { const ScratchPool::Loan loan = pool.borrow(5000); }
  EXPECT_EQ(pool.bytes(), 6000u) << "a block that no longer fits makes place";
  pool.leave(1000);
  EXPECT_EQ(pool.bytes(), 6000u);
  pool.enter(1000);
  pool.leave(5000);
  EXPECT_EQ(pool.bytes(), 1000u) << "blocks that nobody needs any more are freed";
  {
    const ScratchPool::Loan loan = pool.borrow(1000);
    pool.leave(1000);
    EXPECT_EQ(pool.bytes(), 1000u) << "one that is lent stays until it is given back";
  }
  EXPECT_EQ(pool.bytes(), 0u);
}

TEST(ScratchPool, LacksOfMemoryChangeNothing) {
  if (test::kSanitized) GTEST_SKIP() << "operator new ends the program instead of throwing";
  ScratchPool pool;
  pool.enter(100);
  { const ScratchPool::Loan loan = pool.borrow(100); }
  EXPECT_THROW(pool.borrow(std::size_t{1} << 62), std::bad_alloc);
  { const ScratchPool::Loan loan = pool.borrow(100); }
  EXPECT_EQ(pool.bytes(), 100u);
}

DenoiserConfig config_with_gradients(const std::string& recipe) {
  DenoiserConfig config = config_of("balanced");
  config.recipe = recipe;
  config.debug_planes = true;
  config.planes.push_back({PlaneKind::kGradient, {ComponentKind::kIndirect, 0}});
  config.planes.push_back({PlaneKind::kGradient, {ComponentKind::kVisibility, 0}});
  return config;
}

Frame frame_of(const DenoiserConfig& config, std::int64_t index) {
  Frame frame = test::noisy_frame(config, index);
  for (const PlaneId id : config.planes) {
    if (id.kind != PlaneKind::kGradient) continue;
    const PlaneSize size = plane_size(id, config.width, config.height);
    Plane& plane = frame.planes.add(id, size.width, size.height);
    for (int c = 0; c < 2; ++c)
      test::fill(plane.channel(c), 0.5f + 0.1f * static_cast<float>((index + c) % 3));
  }
  // From there on the camera rests.
  if (index >= 4) frame.camera = test::perspective_camera(config.width, config.height);
  frame.cut = index == 2;
  return frame;
}

/// Whether what the blocks of `config`'s pool hold before each frame, by turns, shows in results.
testing::AssertionResult ignores_what_scratch_holds(const DenoiserConfig& config) {
  const auto pool = std::make_shared<ScratchPool>();
  Denoiser spoiled(config, pool), alone(config);
  for (int index = 0; index < 7; ++index) {
    const Frame frame = frame_of(config, index);
    spoil(*pool, index % 2 == 0 ? 0xff : 0x7e);
    const testing::AssertionResult same =
        test::same_bits(test::filtered(spoiled, frame), test::filtered(alone, frame));
    if (!same) return testing::AssertionFailure() << "frame " << index << ": " << same.message();
  }
  return testing::AssertionSuccess();
}

TEST(SharedScratch, NothingOfWhatItHeldShowsUnderAnyRecipe) {
  std::vector<std::string> recipes = recipe_names();
  recipes.insert(recipes.end(), ablation_names().begin(), ablation_names().end());
  for (const std::string& recipe : recipes)
    for (const char* history : {"f32", "f16"}) {
      DenoiserConfig config = config_with_gradients(recipe);
      config.history = history;
      EXPECT_TRUE(ignores_what_scratch_holds(config)) << recipe << ' ' << history;
    }
}

TEST(SharedScratch, NothingOfWhatItHeldShowsUnderAnyPresetBasisOrResolution) {
  for (const std::string& preset : kernel_preset_names())
    for (const char* history : {"f32", "f16"})
      for (const char* basis : {"irradiance", "luminance-cones", "cones"})
        for (const bool half : {false, true}) {
          DenoiserConfig config = config_of(preset);
          config.history = history;
          config.indirect_basis = basis;
          config.debug_planes = true;
          config.half_resolution = {"none"};
          if (half) config.half_resolution = {"indirect", "glossy", "visibility"};
          EXPECT_TRUE(ignores_what_scratch_holds(config))
              << preset << ' ' << history << ' ' << basis << (half ? " half" : "");
        }
}

// Rows of 256 pixels and more have an apron that taps read, at half resolution those of twice that.
TEST(SharedScratch, NothingOfWhatItHeldShowsBesideWideRows) {
  for (const char* history : {"f32", "f16"}) {
    DenoiserConfig fast = config_of("fast", 530, 18), cones = config_of("accurate", 272, 9);
    fast.history = cones.history = history;
    EXPECT_TRUE(ignores_what_scratch_holds(fast)) << history;
    EXPECT_TRUE(ignores_what_scratch_holds(cones)) << history;
    for (const char* recipe : {"reliable", "paper", "paper-adaptive", "svgf", "asvgf", "spatial"}) {
      DenoiserConfig config = config_with_gradients(recipe);
      config.width = 257;
      config.height = 10;
      config.history = history;
      EXPECT_TRUE(ignores_what_scratch_holds(config)) << recipe << ' ' << history;
    }
  }
}

TEST(SharedScratch, NothingOfWhatItHeldShowsWherePlanesLack) {
  DenoiserConfig config = test::shadow_config();
  EXPECT_TRUE(ignores_what_scratch_holds(config));
  config = test::full_config();
  EXPECT_TRUE(ignores_what_scratch_holds(config)) << "no hits, no roughness";
  std::erase(config.planes, test::kIdPlane);
  for (const char* history : {"f32", "f16"}) {
    config.history = history;
    EXPECT_TRUE(ignores_what_scratch_holds(config)) << "no ids, " << history;
  }
  config.lights[0].radiance = {3, 2, 1};
  std::erase(config.planes, test::of_light(PlaneKind::kUnshadowed));
  EXPECT_TRUE(ignores_what_scratch_holds(config)) << "light that is shaded here";
}

TEST(SharedScratch, NothingOfWhatItHeldShowsWhileComponentsRest) {
  for (const char* preset : {"fast", "balanced"}) {
    test::RestWorld world(4, 32, 24);
    world.config.preset = preset;
    const auto pool = std::make_shared<ScratchPool>();
    Denoiser spoiled(world.config, pool), alone(world.config);
    int rested = 0;
    for (int index = 0; index < test::kAtRest + 12; ++index) {
      const Frame frame = world.frame(index, index < test::kAtRest + 8 ? 1 : 0.5);
      PlaneSet one, other;
      if (index % 16 == 0 || index > test::kAtRest - 3) spoil(*pool, 0xff);
      rested += static_cast<int>(spoiled.filter(frame, one).rested.size());
      alone.filter(frame, other);
      ASSERT_TRUE(test::same_bits(one, other)) << preset << " frame " << index;
    }
    EXPECT_GE(rested, 12) << preset;
  }
}

// Of any size, recipe and preset, one frame of each by turns; presets change and sizes, too.
TEST(SharedScratch, DenoisersThatTakeTurnsGiveTheBitsOfThoseWithScratchOfTheirOwn) {
  const auto pool = std::make_shared<ScratchPool>();
  struct Pair {
    DenoiserConfig config;
    Denoiser shared, alone;
  };
  std::vector<Pair> pairs;
  const auto add = [&](DenoiserConfig config) {
    pairs.push_back({config, Denoiser(config, pool), Denoiser(config)});
  };
  add(config_of("balanced", 37, 29));
  add(config_of("fast", 70, 33));
  add(config_of("accurate", 16, 16));
  add(test::shadow_config(50, 20));
  for (const char* recipe : {"svgf", "paper", "spatial"}) {
    DenoiserConfig config = config_of("balanced", 41, 23);
    config.recipe = recipe;
    config.history = "f16";
    add(config);
  }
  for (int index = 0; index < 8; ++index)
    for (Pair& pair : pairs) {
      if (index == 3 && pair.config.width == 37)
        for (Denoiser* denoiser : {&pair.shared, &pair.alone}) denoiser->set_preset("fast");
      if (index == 5 && pair.config.width == 70) {
        pair.config.width = 90;
        pair.shared = Denoiser(pair.config, pair.shared);
        pair.alone = Denoiser(pair.config, pair.alone);
      }
      const Frame frame = test::noisy_frame(pair.config, index);
      ASSERT_TRUE(
          test::same_bits(test::filtered(pair.shared, frame), test::filtered(pair.alone, frame)))
          << pair.config.width << ' ' << pair.config.recipe << ' ' << index;
    }
  EXPECT_EQ(pool->bytes(), pool->largest()) << "one block serves all";
  pairs.clear();
  EXPECT_EQ(pool->bytes(), 0u);
}

TEST(SharedScratch, DenoisersOnSeveralThreadsGiveTheBitsOfThoseAlone) {
  const auto pool = std::make_shared<ScratchPool>();
  constexpr int kThreads = 3;
  const auto last_of = [](int k, const Pool& from) {
    const DenoiserConfig config = config_of("balanced", 30 + 7 * k, 24 + k);
    Denoiser denoiser(config, from);
    PlaneSet results;
    for (int index = 0; index < 12; ++index)
      denoiser.filter(test::noisy_frame(config, index), results);
    return results;
  };
  PlaneSet shared[kThreads];
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads; ++k) threads.emplace_back([&, k] { shared[k] = last_of(k, pool); });
  for (std::thread& thread : threads) thread.join();
  for (int k = 0; k < kThreads; ++k) EXPECT_TRUE(test::same_bits(shared[k], last_of(k, {})));
}

TEST(SharedScratch, IsMostOfWhatADenoiserWorksWith) {
  const Denoiser floats(config_of("balanced", 64, 64));
  EXPECT_GT(floats.scratch_bytes(), 400u * 64 * 64);
  EXPECT_EQ(floats.held_bytes(), floats.history_bytes() + (24 + 8 + 16 + 8) * 64 * 64 + 6 * 64)
      << "guides and a history of one and of three channels to change places with, given vectors; "
         "a cache line before each of the six images";
  DenoiserConfig config = config_of("balanced", 64, 64);
  config.preset = "reference";
  EXPECT_EQ(Denoiser(config).scratch_bytes(), 0u);
}

}  // namespace
}  // namespace holdfast
