#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tests/core/denoiser_world.h"
#include "tests/core/rest_world.h"

namespace {
std::atomic<std::size_t> largest_allocation{0};

void note(std::size_t bytes) {
  std::size_t seen = largest_allocation.load();
  while (seen < bytes && !largest_allocation.compare_exchange_weak(seen, bytes)) {
  }
}
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  note(bytes);
  if (void* p = std::malloc(std::max<std::size_t>(bytes, 1))) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  note(bytes);
  const auto step = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(step, (bytes + step - 1) / step * step)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace holdfast {
namespace {

// Reports, the tables of the scene and the task scheduler may take small pieces; an image of this
// size has 33 kB.
TEST(Denoiser, AllocatesNothingOfAnImagesSizePerFrameAfterTheFirst) {
  for (const std::string& recipe : recipe_names()) {
    DenoiserConfig config = test::full_config(130, 64);
    config.planes.push_back({PlaneKind::kIndirectDirection, {}});
    config.recipe = recipe;
    config.preset = recipe == "reliable" || recipe == "svgf" ? "fast" : "balanced";
    if (recipe == "paper") config.half_resolution = {"indirect"};  // with cones
    config.debug_planes = true;
    Denoiser denoiser(config);
    PlaneSet results;
    for (int index = 0; index < 5; ++index) {
      Frame frame = test::noisy_frame(config, index);
      frame.cut = index == 3;
      largest_allocation = 0;
      denoiser.filter(frame, results);
      if (index == 0) {
        EXPECT_GT(largest_allocation, 130u * 64u * 4u) << "the results' planes: the count counts";
      } else {
        EXPECT_LT(largest_allocation, 4096u) << recipe << " frame " << index;
      }
    }
  }
}

// Sessions of several sizes and recipes that share their scratch, each with a frame in turn.
TEST(Denoiser, AllocatesNothingOfAnImagesSizeWhereScratchIsShared) {
  const auto pool = std::make_shared<ScratchPool>();
  struct Session {
    DenoiserConfig config;
    Denoiser denoiser;
    PlaneSet results;
  };
  std::vector<Session> sessions;
  for (const auto& [width, height] : {std::pair(130, 64), {100, 100}, {260, 70}, {130, 64}})
    for (const char* history : {"f32", "f16"}) {
      DenoiserConfig config = test::full_config(width, height);
      config.history = history;
      sessions.push_back({config, Denoiser(config, pool), {}});
    }
  for (int index = 0; index < 4; ++index)
    for (Session& session : sessions) {
      const Frame frame = test::noisy_frame(session.config, index);
      largest_allocation = 0;
      session.denoiser.filter(frame, session.results);
      if (index > 0) {
        EXPECT_LT(largest_allocation, 4096u) << session.config.width << " frame " << index;
      }
    }
}

TEST(Denoiser, AllocatesNothingOfAnImagesSizeWhereComponentsRest) {
  test::RestingSession session(test::RestWorld(4, 130, 64));
  for (int i = 0; i < 8; ++i) {
    const Frame frame = session.world.frame(session.next);
    largest_allocation = 0;
    session.filter(frame);
    EXPECT_LT(largest_allocation, 4096u) << i;
    EXPECT_FALSE(session.report.rested.empty());
  }
}

}  // namespace
}  // namespace holdfast
