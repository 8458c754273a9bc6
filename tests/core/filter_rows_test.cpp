#include "core/spatial/filter_rows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

constexpr int kWidths[] = {1, 3, 16, 61, 200};
constexpr double kRounding = 1e-6;  // a few roundings of 6e-8 each

std::vector<float> random_row(test::Random& random, int width) {
  std::vector<float> row;
  for (int x = 0; x < width; ++x) row.push_back(random.real(0.1f, 4));
  return row;
}

/// Calls body(width) for every width and instruction set.
template <class Body>
void everywhere(const Body& body) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    SCOPED_TRACE(isa_name(isa));
    for (const int width : kWidths) body(width);
  }
}

TEST(FilterRows, LuminanceIsRec709OrTheOnlyChannel) {
  test::Random random(71);
  everywhere([&](int width) {
    const auto r = random_row(random, width), g = random_row(random, width),
               b = random_row(random, width);
    std::vector<float> out(r.size()), squares(r.size());
    luminance_row({{r.data(), g.data(), b.data()}, 3, width, out.data(), squares.data()});
    for (std::size_t x = 0; x < r.size(); ++x) {
      const double l = 0.2126 * double(r[x]) + 0.7152 * double(g[x]) + 0.0722 * double(b[x]);
      ASSERT_NEAR(out[x], l, kRounding * l);
      ASSERT_NEAR(squares[x], l * l, 3 * kRounding * l * l);
    }
    luminance_row({{r.data(), r.data(), r.data()}, 1, width, out.data(), nullptr});
    ASSERT_EQ(out, r);
  });
}

TEST(FilterRows, ToleranceIsInverseStandardDeviations) {
  test::Random random(72);
  everywhere([&](int width) {
    auto mean = random_row(random, width);
    const auto variance = random_row(random, width), samples = random_row(random, width);
    mean[0] = 0.0f;
    std::vector<float> out(mean.size());
    tolerance_row({mean.data(), variance.data(), samples.data(), 4.0f, width, out.data()});
    for (std::size_t x = 0; x < mean.size(); ++x) {
      const double want =
          1 / (4 * std::sqrt(double(variance[x]) / double(samples[x])) + 1e-3 * double(mean[x]));
      ASSERT_NEAR(out[x], want, kRounding * want);
    }
  });
}

TEST(FilterRows, FootprintsNarrowWithTheFourthRootOfTheSamples) {
  test::Random random(73);
  everywhere([&](int width) {
    const auto in = random_row(random, width), samples = random_row(random, width);
    std::vector<float> out[3];
    for (auto& o : out) o.resize(in.size());
    narrow_row({{in.data(), in.data(), in.data()},
                samples.data(),
                width,
                {out[0].data(), out[1].data(), out[2].data()}});
    for (std::size_t x = 0; x < in.size(); ++x)
      for (const auto& o : out)
        ASSERT_NEAR(o[x], double(in[x]) * std::pow(double(samples[x]), 0.25), 4 * kRounding);
  });
}

TEST(FilterRows, StatisticsHaveAFloorAndFootprintsFadeWithoutBlockers) {
  test::Random random(74);
  everywhere([&](int width) {
    const auto mean = random_row(random, width);
    auto square = random_row(random, width), valid = random_row(random, width),
         precision = random_row(random, width);
    const auto square_before = square;
    valid[0] = 0.0f;
    precision[0] = 0.0f;
    for (std::size_t x = 1; x < valid.size(); x += 5) precision[x] = 0.5f * (valid[x] = 1e-9f);
    std::vector<float> footprint[3];
    for (auto& f : footprint) f.resize(mean.size());
    statistics_row({mean.data(),
                    square.data(),
                    1e-2f,
                    1e-3f,
                    valid.data(),
                    {precision.data(), precision.data(), precision.data()},
                    width,
                    square.data(),
                    {footprint[0].data(), footprint[1].data(), footprint[2].data()}});
    for (std::size_t x = 0; x < mean.size(); ++x) {
      const double m = double(mean[x]) * double(mean[x]);
      const double want = std::max(double(square_before[x]) - m, 1e-2 * m + 1e-3);
      ASSERT_NEAR(square[x], want, 20 * kRounding) << "of squares of up to 16";
      for (const auto& f : footprint)
        ASSERT_NEAR(f[x], double(precision[x]) / std::max(double(valid[x]), 1e-3), 50 * kRounding)
            << "a footprint that almost nothing speaks for is none";
    }
  });
}

TEST(FilterRows, MomentVarianceGrowsWhereHistoryIsYoung) {
  test::Random random(75);
  everywhere([&](int width) {
    const auto mean = random_row(random, width), square = random_row(random, width),
               sample = random_row(random, width);
    auto frames = random_row(random, width);
    for (std::size_t x = 0; x < frames.size(); ++x) frames[x] = 1.0f + static_cast<float>(x % 6);
    std::vector<float> out(mean.size());
    moment_variance_row(
        {mean.data(), square.data(), frames.data(), sample.data(), width, out.data()});
    for (std::size_t x = 0; x < mean.size(); ++x) {
      const double variance = std::max(double(square[x]) - double(mean[x]) * double(mean[x]), 0.0);
      const double young = std::max(variance, double(sample[x])) * 4 / double(frames[x]);
      ASSERT_NEAR(out[x], frames[x] < 4 ? young : variance, 20 * kRounding) << "of up to 16";
    }
  });
}

TEST(FilterRows, SmoothToleranceIsOfAGaussianOfNineWhoseBordersRepeat) {
  constexpr double kGauss[2] = {0.5, 0.25};
  test::Random random(76);
  everywhere([&](int width) {
    std::vector<float> variance[3];
    for (auto& row : variance) row = random_row(random, width);
    const auto luminance = random_row(random, width);
    std::vector<float> out(luminance.size());
    smooth_tolerance_row({{variance[0].data(), variance[1].data(), variance[2].data()},
                          luminance.data(),
                          4.0f,
                          width,
                          out.data()});
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          sum += kGauss[std::abs(i)] * kGauss[std::abs(j)] *
                 double(variance[j + 1][static_cast<std::size_t>(std::clamp(x + i, 0, width - 1))]);
      const auto at = static_cast<std::size_t>(x);
      const double want = 1 / (4 * std::sqrt(sum) + 1e-4 * double(luminance[at]));
      ASSERT_NEAR(out[at], want, kRounding * want) << x;
    }
  });
}

}  // namespace
}  // namespace holdfast
