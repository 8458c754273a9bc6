#pragma once

#include <array>
#include <utility>

#include "core/history/radiance_blend.h"
#include "tests/core/history_world.h"

namespace holdfast::test {

/// A still wall whose radiance is blended with its history.
struct RadianceHistory : StillHistory {
  static constexpr int kWidth = 24, kHeight = 20;
  RadianceBlendScratch scratch{kWidth, kHeight, 2};
  WindowScratch window{kWidth, kHeight};
  RadianceBlendRule rule;
  bool at_rest = false;

  RadianceHistory() : StillHistory(kWidth, kHeight, 3) {}
  void run(const HistorySources& sources, Channels<float>* debug = nullptr,
           const Channels<float>* footprint = nullptr) {
    blend_radiance(guides, noisy, sources, footprint, rule, at_rest, before, scratch, window, now,
                   debug);
  }
  template <class Body>
  static void each(const Body& body) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) body(x, y);
  }
  /// Noise of mean `colour`, uniform in 0..2 of it.
  void render(Random& random, const std::array<float, 3>& colour) {
    each([&](int x, int y) {
      const float brightness = random.real(0, 2);
      for (int c = 0; c < 3; ++c)
        noisy[c].at(x, y) = brightness * colour[static_cast<std::size_t>(c)];
    });
  }
  void fill_history(const std::array<float, 3>& colour, float samples) {
    for (int c = 0; c < 3; ++c) fill(before.data[c], colour[static_cast<std::size_t>(c)]);
    fill(before.samples(), samples);
  }
  void step() {
    run(by_surface());
    std::swap(before, now);
  }
};

}  // namespace holdfast::test
