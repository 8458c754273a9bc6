#include "core/history/light_change.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/history_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = 75, kHeight = 53, kTile = LightChange::kTile;  // tiles cut at both edges
constexpr int kColumns = (kWidth + kTile - 1) / kTile, kRows = (kHeight + kTile - 1) / kTile;

/// A history and its differences to a frame, as a blend of radiance gathers them.
struct Gathered {
  Guides guides = test::wall(test::orthographic_camera(kWidth, kHeight), kWidth, kHeight);
  Channels<float> values{kWidth, kHeight, 4}, differences{kWidth, kHeight, 4};
  Channels<float> frame{kWidth, kHeight, 3};
  LightChange change{kWidth, kHeight};
  LightChangeRule rule{.noticed = true};

  Gathered() { test::fill(values[3], 8.0f); }

  template <class Body>
  static void each(const Body& body) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) body(x, y);
  }
  /// Values of 1, differences uniform in -1..1.
  void noise(test::Random& random) {
    each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) {
        values[c].at(x, y) = 1.0f;
        differences[c].at(x, y) = random.real(-1, 1);
      }
    });
  }
  void shift_tile(int column, int row, float by) {
    each([&](int x, int y) {
      if (x / kTile != column || y / kTile != row) return;
      for (int c = 0; c < 3; ++c) differences[c].at(x, y) += by;
    });
  }
  void shift(int columns, float by) {
    each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) differences[c].at(x, y) += x < columns ? by : 0.0f;
    });
  }
  TileSignal signal() {
    each([&](int x, int y) {
      for (int c = 0; c < 3; ++c) frame[c].at(x, y) = values[c].at(x, y) - differences[c].at(x, y);
    });
    return {
        guides, {values[0], values[1], values[2]}, values[3], {frame[0], frame[1], frame[2]}, 3};
  }
  void measure_moving() { change.measure_moving(signal(), rule); }
  void measure() { change.measure(signal(), rule); }
  bool tile_marked(int column, int row) const {
    return change.changed(column * kTile, row * kTile);
  }
  int marked() const {
    int count = 0;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) count += tile_marked(column, row) ? 1 : 0;
    return count;
  }
};

/// The squared bias that a square of tiles shows by the formula, in variances of a difference: in
/// two passes over a list of its pixels.
double bias_of(const Gathered& g, int column, int row, int size, double deviations) {
  std::vector<glm::dvec3> d, h;
  for (int y = row * kTile; y < std::min(kHeight, (row + size) * kTile); ++y)
    for (int x = column * kTile; x < std::min(kWidth, (column + size) * kTile); ++x) {
      if (!(g.guides.depth().at(x, y) > 0.0f) || !(g.values[3].at(x, y) > 0.0f)) continue;
      d.emplace_back(g.differences[0].at(x, y), g.differences[1].at(x, y),
                     g.differences[2].at(x, y));
      h.emplace_back(g.values[0].at(x, y), g.values[1].at(x, y), g.values[2].at(x, y));
    }
  if (d.size() < 2) return 0;
  const auto n = static_cast<double>(d.size());
  glm::dvec3 mean(0), level(0);
  for (const glm::dvec3& v : d) mean += v / n;
  for (const glm::dvec3& v : h) level += v / n;
  double variance = 0;
  for (const glm::dvec3& v : d) variance += glm::dot(v - mean, v - mean) / n;
  const double shift = glm::dot(mean, mean), error = variance / n;
  return shift > deviations * deviations * error &&
                 glm::length(mean) > double{g.rule.least_share} * glm::length(level)
             ? (shift - deviations * deviations * error) / variance
             : 0;
}

/// The tile's own verdict.
bool differs(const Gathered& g, int column, int row, double deviations) {
  return bias_of(g, column, row, 1, deviations) > 0;
}

TEST(LightChange, NoiseAloneMarksNothing) {
  Gathered g;
  g.rule.frame_share = 0.02f;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    test::Random random(seed);
    g.noise(random);
    g.measure();
    ASSERT_EQ(g.marked(), 0) << seed;
    ASSERT_EQ(g.change.share(), 0.0);
    ASSERT_EQ(g.change.bias(20, 20), 0.0f);
  }
}

TEST(LightChange, TilesAreMarkedAsTheFormulaSaysAndAllAroundThem) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Gathered g;
    test::Random random(seed);
    g.noise(random);
    Gathered::each([&](int x, int y) {
      if (random.uniform() < 0.1) g.values[3].at(x, y) = 0.0f;
      if (random.uniform() < 0.1) test::set_pixel(g.guides, x, y, 0.0f, glm::vec3(0));
    });
    for (int k = 0; k < 3; ++k)
      g.shift_tile(static_cast<int>(random.real(0, kColumns)),
                   static_cast<int>(random.real(0, kRows)), random.real(0.0f, 0.5f));
    g.measure();
    int own = 0;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double limit = double{g.rule.tile_deviations};
        own += differs(g, column, row, limit) ? 1 : 0;
        bool expected = false;
        for (int j = std::max(row - 1, 0); j <= std::min(row + 1, kRows - 1); ++j)
          for (int i = std::max(column - 1, 0); i <= std::min(column + 1, kColumns - 1); ++i)
            expected |= differs(g, i, j, limit);
        ASSERT_EQ(g.tile_marked(column, row), expected) << seed << ": " << column << ' ' << row;
      }
    EXPECT_NEAR(g.change.share(), double(own) / (kColumns * kRows), 1e-12);
  }
}

// 0.25 is less than half the deviation of a single difference: 49 pixels would show 3 deviations.
TEST(LightChange, AShiftBelowTheNoiseOfAPixelIsFoundInItsTile) {
  Gathered g;
  test::Random random(5);
  g.noise(random);
  g.shift_tile(1, 1, 0.25f);
  g.measure();
  EXPECT_EQ(g.marked(), 9);
  EXPECT_TRUE(g.tile_marked(0, 0) && g.tile_marked(2, 2));
  EXPECT_FALSE(g.tile_marked(3, 1));
  g.change.clear();
  EXPECT_EQ(g.marked(), 0);
}

TEST(LightChange, ManyTilesThatEachDifferTooLittleMarkTheFrameWhereTheRuleSaysSo) {
  for (const bool whole : {false, true}) {
    Gathered g;
    test::Random random(6);
    g.noise(random);
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column)
        if ((row + column) % 2 == 0) g.shift_tile(column, row, 0.15f);
    g.rule.tile_deviations = 1e6f;  // never
    if (whole) g.rule.frame_share = 0.02f;
    g.measure();
    EXPECT_EQ(g.marked(), whole ? kColumns * kRows : 0);
    EXPECT_EQ(g.change.share(), whole ? 1.0 : 0.0);
  }
}

TEST(LightChange, BiasIsTheLargestThatTileGroupAndFrameShow) {
  constexpr int kGroup = LightChange::kGroup;
  int by_group = 0, by_frame = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Gathered g;
    g.rule.moving_deviations = 4.0f;
    test::Random random(seed);
    g.noise(random);
    Gathered::each([&](int x, int y) {
      if (random.uniform() < 0.1) g.values[3].at(x, y) = 0.0f;
      if (random.uniform() < 0.1) test::set_pixel(g.guides, x, y, 0.0f, glm::vec3(0));
    });
    g.shift(seed % 2 == 0 ? kGroup * kTile : kWidth, random.real(0.0f, 0.2f));
    g.shift_tile(1, 1, random.real(0.0f, 0.5f));
    for (const bool moving : {false, true}) {
      moving ? g.measure_moving() : g.measure();
      const double limit = double{g.rule.tile_deviations};
      const double group_limit = moving ? double{g.rule.moving_deviations} : limit;
      for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
          const double tile = bias_of(g, column, row, 1, limit);
          const double group =
              bias_of(g, column / kGroup * kGroup, row / kGroup * kGroup, kGroup, group_limit);
          const double frame = bias_of(g, 0, 0, kColumns, double{g.rule.frame_deviations});
          by_group += group > std::max(tile, frame) ? 1 : 0;
          by_frame += frame > std::max(tile, group) ? 1 : 0;
          ASSERT_NEAR(double{g.change.bias(column * kTile, row * kTile)},
                      std::max({tile, group, frame}), 1e-5)
              << seed << ": " << column << ' ' << row;
          ASSERT_FALSE(moving && g.tile_marked(column, row));
        }
    }
  }
  EXPECT_GT(by_group, 100);
  EXPECT_GT(by_frame, 100);
}

// A tile's mean has an error of 1/16 of a deviation here, the frame's one of 1/63.
TEST(LightChange, AShiftBelowTheNoiseOfATileIsExpectedOfEveryPixel) {
  Gathered g;
  test::Random random(8);
  g.noise(random);
  g.shift(kWidth, 0.05f);
  g.measure();
  EXPECT_EQ(g.marked(), 0);
  Gathered::each([&](int x, int y) {
    ASSERT_NEAR(g.change.bias(x, y), 3 * 0.05f * 0.05f, 0.005f) << x << ' ' << y;
  });
  g.change.clear();
  EXPECT_EQ(g.change.bias(0, 0), 0.0f);
}

TEST(LightChange, ABiasWithoutNoiseIsTheLargestOfAll) {
  Gathered g;
  Gathered::each([&](int x, int y) {
    for (int c = 0; c < 3; ++c) g.values[c].at(x, y) = g.differences[c].at(x, y) = 0.5f;
  });
  g.measure_moving();
  EXPECT_EQ(g.change.bias(3, 3), TileSums::kMostBias);
}

TEST(LightChange, RoundingOfAConstantImageIsNoChange) {
  Gathered g;
  Gathered::each([&](int x, int y) {
    for (int c = 0; c < 3; ++c) {
      g.values[c].at(x, y) = 1e3f;
      g.differences[c].at(x, y) = 6e-5f;
    }
  });
  g.measure();
  EXPECT_EQ(g.marked(), 0);
  EXPECT_EQ(g.change.bias(0, 0), 0.0f);
}

TEST(LightChange, WithoutHistoryNothingIsKnownToChange) {
  Gathered g;
  test::Random random(7);
  g.noise(random);
  g.shift_tile(1, 1, 5.0f);
  test::fill(g.values[3], 0.0f);
  g.measure();
  EXPECT_EQ(g.marked(), 0);
  EXPECT_EQ(g.change.share(), 0.0);
}

}  // namespace
}  // namespace holdfast
