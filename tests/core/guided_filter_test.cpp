#include "core/spatial/guided_filter.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <ostream>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/kernels/isa.h"
#include "core/spatial/adaptive_filter.h"
#include "core/spatial/tap_weights.h"
#include "tests/core/filter_oracle.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

/// One of the combinations that `filter_row` is compiled for.
struct Combination {
  int channels;
  Spread spread;
  bool luminance, footprint;

  /// Without luminance, only weights of three channels are found by the pass itself.
  bool needs_kept_weights() const { return !luminance && channels != 3; }
  bool has(int step, int radius) const {
    return !needs_kept_weights() || (radius == 1 && TapWeights::has(step));
  }
};

constexpr Combination kCombinations[] = {
    {1, Spread::kSamples, false, false},  {1, Spread::kSamples, false, true},
    {1, Spread::kNone, false, false},     {2, Spread::kNone, false, false},
    {3, Spread::kNone, false, false},     {7, Spread::kNone, false, false},
    {8, Spread::kNone, false, false},     {2, Spread::kVariance, false, false},
    {4, Spread::kVariance, false, false}, {4, Spread::kVariance, false, true},
    {2, Spread::kVariance, false, true},  {1, Spread::kSamples, true, false},
    {3, Spread::kSamples, true, false},   {1, Spread::kVariance, true, false},
    {3, Spread::kVariance, true, false},  {1, Spread::kSamples, true, true},
    {3, Spread::kSamples, true, true}};

std::ostream& operator<<(std::ostream& os, const Combination& c) {
  return os << c.channels << " channels, "
            << (c.spread == Spread::kSamples    ? "samples"
                : c.spread == Spread::kVariance ? "variance"
                                                : "no spread")
            << (c.luminance ? ", luminance" : "") << (c.footprint ? ", footprint" : "");
}

/// Random images on random surfaces: slanted planes that meet at edges, noise on depth and normal,
/// and sky.
struct Images {
  Camera camera;
  Guides guides;
  Channels<float> in, out, spread, guide, footprint;
  TapWeights kept;

  Images(const Camera& view, int width, int height, test::Random& random)
      : camera(view),
        guides(test::empty_guides(view, width, height)),
        in(width, height, kMaxFilterChannels),
        out(width, height, kMaxFilterChannels),
        spread(width, height, 2),
        guide(width, height, 2),
        footprint(width, height, 3),
        kept(width, height) {
    const glm::vec3 up(guides.view.rays.forward * -1.0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool far = (x / 5 + y / 7) % 3 == 0;
        const glm::vec3 tilt(far ? 0.3f : -0.2f, 0.1f, 0);
        const glm::vec3 noise = 0.05f * glm::vec3(random.in_box(1));
        const float depth =
            (far ? 9.0f : 4.0f) + 0.02f * static_cast<float>(x) + random.real(0, 0.02f);
        if (random.uniform() < 0.1)
          test::set_pixel(guides, x, y, 0.0f, glm::vec3(0));
        else
          test::set_pixel(guides, x, y, depth, glm::normalize(up + tilt + noise));
      }
    for (int c = 0; c < kMaxFilterChannels; ++c) test::fill_random(in[c], random, 0, 1);
    test::fill_random(spread[0], random, 0.5f, 20);
    test::fill_random(guide[0], random, 0, 1);
    test::fill_random(guide[1], random, 0, 8);
    test::fill_random(footprint[0], random, 0, 0.2f);
    test::fill_random(footprint[2], random, 0, 0.2f);
    for (int y = 0; y < height; ++y)  // positive definite, as a covariance is
      for (int x = 0; x < width; ++x)
        footprint[1].at(x, y) =
            random.real(-0.9f, 0.9f) * std::sqrt(footprint[0].at(x, y) * footprint[2].at(x, y));
    // Nothing may read further past the end of a row than its apron, not even with weight 0.
    for (int c = 0; c < 4; ++c) test::poison_padding(guides.depth_normal[c]);
    for (int c = 0; c < kMaxFilterChannels; ++c) test::poison_padding(in[c]);
    test::poison_padding(spread[0]);
    for (int c = 0; c < 2; ++c) test::poison_padding(guide[c]);
    for (int c = 0; c < 3; ++c) test::poison_padding(footprint[c]);
  }

  FilterPass pass(const Combination& combination, int step, int radius) {
    return pass(combination, step, FilterWeights{.radius = radius});
  }
  FilterPass pass(const Combination& combination, int step, const FilterWeights& weights) {
    FilterPass row;
    kept.clear();
    row.guides = &guides;
    row.kept = &kept;
    row.weights = weights;
    row.step = step;
    row.channels = combination.channels;
    row.spread = combination.spread;
    for (int c = 0; c < combination.channels; ++c) {
      row.in[c] = in[c];
      row.out[c] = out[c];
    }
    if (combination.spread != Spread::kNone) {
      row.spread_in = spread[0];
      row.spread_out = spread[1];
    }
    if (combination.luminance) {
      row.luminance = guide[0];
      row.inverse_luminance_sigma = guide[1];
    }
    if (combination.footprint)
      for (int c = 0; c < 3; ++c) row.footprint[c] = footprint[c];
    return row;
  }
};

constexpr std::pair<int, int> kSizes[] = {{1, 1},  {1, 7},    {5, 1},   {3, 3},
                                          {17, 9}, {129, 33}, {260, 5}, {257, 3}};

class IsaGuard {
 public:
  IsaGuard() : before_(selected_isa()) {}
  ~IsaGuard() { select_isa(before_); }

 private:
  Isa before_;
};

// Float rounding of a plane distance is about 1e-7 of the depth, thus 1e-7 / pixel angle (1/30 at
// 33 rows, 1 m / 5 rows ...) of its tolerance, plus 4e-6 of the polynomial exponential: an exponent
// that is off by 3e-5 shifts a weighted mean of values in 0..1 by less than 2e-5.
constexpr double kTolerance = 2e-5;

// Kept weights are rounded by up to 7.6e-6, which counts as many times as a tap has more samples
// than the pixel: here up to 40.
constexpr double kKeptSamplesTolerance = 6e-5;

void expect_oracle(Images& images, const Combination& combination, int step,
                   const FilterWeights& weights) {
  const FilterPass pass = images.pass(combination, step, weights);
  const test::FilterOracle oracle(pass, images.camera);
  const int width = images.guides.view.width, height = images.guides.view.height;
  std::vector<test::OraclePixel> expected;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) expected.push_back(oracle.at(x, y));
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    images.kept.clear();
    filter_image(pass);
    double worst = 0;
    auto want = expected.begin();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x, ++want) {
        for (int c = 0; c < combination.channels; ++c) {
          const double error = std::abs(double(pass.out[c].at(x, y)) - want->values[c]);
          worst = std::max(worst, std::isnan(error) ? 1e9 : error);
        }
        if (combination.spread == Spread::kNone) continue;
        const double error = std::abs(double(pass.spread_out.at(x, y)) / want->spread - 1);
        worst = std::max(worst, std::isnan(error) ? 1e9 : 0.5 * error);  // squares count twice
      }
    const bool kept = combination.needs_kept_weights();
    const bool amplified = kept && combination.spread == Spread::kSamples;
    for (int c = 0; c < combination.channels; ++c)
      ASSERT_TRUE(test::has_clean_apron(pass.out[c])) << isa_name(isa) << ", " << combination;
    ASSERT_LE(worst, amplified ? kKeptSamplesTolerance : kTolerance)
        << isa_name(isa) << ", " << width << "x" << height << ", " << combination << ", step "
        << step << ", radius " << weights.radius << (weights.diamond ? ", diamond" : "");
  }
}

void expect_oracle_at_every_size(Camera (*camera)(int, int, glm::dvec3, glm::dvec3)) {
  const IsaGuard guard;
  test::Random random(21);
  for (const auto& [width, height] : kSizes) {
    Images images(camera(width, height, {3, 1, -2}, {0.4, -0.3, -1}), width, height, random);
    for (const Combination& combination : kCombinations)
      for (const int step : {1, 2, 3, 4, 8, 128})
        for (const int radius : {1, 2})
          if (combination.has(step, radius))
            expect_oracle(images, combination, step, FilterWeights{.radius = radius});
  }
}

TEST(GuidedFilter, AgreesWithTheOracleUnderAPerspectiveCamera) {
  expect_oracle_at_every_size(test::perspective_camera);
}

TEST(GuidedFilter, AgreesWithTheOracleUnderAnOrthographicCamera) {
  expect_oracle_at_every_size(test::orthographic_camera);
}

TEST(GuidedFilter, AgreesWithTheOracleWithEveryKernel) {
  const IsaGuard guard;
  test::Random random(27);
  for (const auto& [width, height] : kSizes) {
    Images images(test::perspective_camera(width, height), width, height, random);
    for (const Combination& combination : kCombinations)
      for (const FilterWeights& weights : {kernel_of(9), kernel_of(13), kernel_of(25)})
        for (const int step : {1, 2, 4})
          if (combination.has(step, weights.radius))
            expect_oracle(images, combination, step, weights);
  }
}

TEST(GuidedFilter, KernelsHaveAsManyTapsAsTheirNameSays) {
  const int size = 21;
  test::Random random(30);
  Images images(test::orthographic_camera(size, size), size, size, random);
  images.guides = test::wall(images.camera, size, size);
  test::fill(images.in[0], 0.0f);
  images.in[0].at(10, 10) = 1.0f;
  test::fill(images.spread[0], 1.0f);
  for (const int taps : {9, 13, 25}) {
    const FilterPass pass = images.pass({3, Spread::kNone, false, false}, 3, kernel_of(taps));
    filter_image(pass);
    int reached = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) reached += pass.out[0].at(x, y) > 0.0f;
    EXPECT_EQ(reached, taps);
    EXPECT_EQ(pass.out[0].at(16, 10) > 0.0f, taps > 9) << "two steps beside";
    EXPECT_EQ(pass.out[0].at(16, 13) > 0.0f, taps > 13) << "and one below";
  }
}

TEST(GuidedFilter, OneAndManyThreadsGiveTheSameBits) {
  test::Random random(22);
  Images images(test::perspective_camera(129, 67), 129, 67, random);
  for (const Combination& combination : kCombinations) {
    const FilterPass pass = images.pass(combination, 2, combination.has(2, 2) ? 2 : 1);
    std::vector<float> results[2];
    for (const int k : {0, 1}) {
      const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                        k == 0 ? 1 : 8);
      images.kept.clear();
      filter_image(pass);
      for (int y = 0; y < 67; ++y) {
        for (int c = 0; c < combination.channels; ++c)
          results[k].insert(results[k].end(), pass.out[c].row(y), pass.out[c].row(y) + 129);
        if (combination.spread == Spread::kNone) continue;
        results[k].insert(results[k].end(), pass.spread_out.row(y), pass.spread_out.row(y) + 129);
      }
    }
    EXPECT_EQ(std::memcmp(results[0].data(), results[1].data(), 4 * results[0].size()), 0)
        << combination;
  }
}

TEST(GuidedFilter, ConstantImageIsAFixedPoint) {
  test::Random random(23);
  Images images(test::perspective_camera(65, 40), 65, 40, random);
  for (int c = 0; c < kMaxFilterChannels; ++c) test::fill(images.in[c], 0.7f);
  for (const Combination& combination : kCombinations) {
    filter_image(images.pass(combination, 2, combination.has(2, 2) ? 2 : 1));
    for (int c = 0; c < combination.channels; ++c)
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 65; ++x)
          ASSERT_NEAR(images.out[c].at(x, y), 0.7f, 1e-6f) << combination;  // 25 roundings
  }
}

TEST(GuidedFilter, KeepsTheEnergyOfAnImpulseOnAFlatSurface) {
  const int size = 41;
  test::Random random(24);
  Images images(test::orthographic_camera(size, size), size, size, random);
  images.guides = test::wall(images.camera, size, size);
  test::fill(images.in[0], 0.0f);
  images.in[0].at(20, 20) = 1.0f;
  test::fill(images.spread[0], 1.0f);
  for (const int step : {1, 2, 4}) {
    const FilterPass pass = images.pass({3, Spread::kNone, false, false}, step, 2);
    filter_image(pass);
    double sum = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) sum += double(pass.out[0].at(x, y));
    EXPECT_NEAR(sum, 1.0, 1e-5) << "step " << step;
    EXPECT_NEAR(pass.out[0].at(20 + 2 * step, 20), 3.0f / 128, 1e-5f) << "3/8 times 1/16";
  }
}

// On a flat surface the weights are the kernel's: sum h^2 = (2/256 + 2/16 + 9/64)^2 = (35/128)^2.
TEST(GuidedFilter, VarianceAndSamplesPropagateByTheKernelsSquares) {
  test::Random random(25);
  Images images(test::orthographic_camera(15, 15), 15, 15, random);
  images.guides = test::wall(images.camera, 15, 15);
  test::fill(images.spread[0], 4.0f);
  const float squares = 35.0f / 128 * 35.0f / 128;
  test::fill(images.guide[0], 0.5f);
  filter_image(images.pass({3, Spread::kVariance, true, false}, 1, 2));
  EXPECT_NEAR(images.spread[1].at(7, 7), 4.0f * squares, 1e-4f);
  filter_image(images.pass({1, Spread::kSamples, true, false}, 1, 2));
  EXPECT_NEAR(images.spread[1].at(7, 7), 4.0f / squares, 1e-2f);
}

// Weights are kept until they are cleared: what a pass finds, those after it use.
TEST(GuidedFilter, KeepsItsWeightsForTheFrame) {
  test::Random random(28);
  Images images(test::perspective_camera(40, 30), 40, 30, random);
  const FilterPass pass = images.pass({2, Spread::kVariance, false, false}, 2, 1);
  const auto result = [&] {
    filter_image(pass);
    return std::vector<float>(pass.out[0].row(15), pass.out[0].row(15) + 40);
  };
  const auto first = result();
  images.guides = test::wall(images.camera, 40, 30);
  EXPECT_EQ(result(), first);
  images.kept.clear();
  EXPECT_NE(result(), first);
}

// Where only some tiles are active, their weights alone are found, and those of others later.
TEST(GuidedFilter, FindsWeightsOfTilesAsTheyBecomeActive) {
  const int width = 100, height = 40;
  test::Random random(29);
  Images images(test::perspective_camera(width, height), width, height, random);
  Channels<float> varying(width, height, 1);
  varying[0].at(50, 20) = 1.0f;
  ActivityMap few(width, height);
  few.measure(images.guides, {{std::as_const(varying)[0]}}, 1, 0.0f);
  FilterPass pass = images.pass({4, Spread::kVariance, false, true}, 3, 1);
  pass.activity = &few;
  filter_image(pass);
  pass.activity = nullptr;
  filter_image(pass);
  Channels<float> later(width, height, 1);
  for (int y = 0; y < height; ++y) std::copy_n(pass.out[3].row(y), width, later[0].row(y));
  images.kept.clear();
  filter_image(pass);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      ASSERT_EQ(pass.out[3].at(x, y), later[0].at(x, y)) << x << ", " << y;
}

TEST(GuidedFilter, SkyCopiesItsInputAndGivesNothingToSurfaces) {
  test::Random random(26);
  Images images(test::perspective_camera(16, 8), 16, 8, random);
  images.guides = test::wall(images.camera, 16, 8);
  test::fill(images.in[0], 1.0f);
  for (int y = 0; y < 8; ++y)
    for (int x = 8; x < 16; ++x) {
      test::set_pixel(images.guides, x, y, 0.0f, glm::vec3(0));
      images.in[0].at(x, y) = 1e15f;
    }
  for (const Spread spread : {Spread::kVariance, Spread::kSamples}) {
    filter_image(images.pass({spread == Spread::kVariance ? 2 : 1, spread, false, false}, 1, 1));
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) {
        EXPECT_NEAR(images.out[0].at(x, y), x < 8 ? 1.0f : 1e15f, x < 8 ? 1e-6f : 0.0f);
        if (x < 8) continue;
        EXPECT_EQ(images.spread[1].at(x, y), images.spread[0].at(x, y));
      }
  }
}

}  // namespace
}  // namespace holdfast
