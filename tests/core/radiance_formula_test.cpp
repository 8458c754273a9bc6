#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/history/radiance_blend.h"
#include "tests/core/radiance_history.h"

namespace holdfast {
namespace {

constexpr int kWidth = test::RadianceHistory::kWidth, kHeight = test::RadianceHistory::kHeight;
using Blend = test::RadianceHistory;

/// Two passes of 3x3 means on a flat wall, the second at step 2: of values, or of variances.
std::vector<double> plain_window(const std::vector<double>& in, bool variances) {
  std::vector<double> from = in, to(in.size());
  for (const int reach : {1, 2}) {
    Blend::each([&](int x, int y) {
      double sum = 0, n = 0;
      for (int j = y - reach; j <= y + reach; j += reach)
        for (int i = x - reach; i <= x + reach; i += reach)
          if (i >= 0 && j >= 0 && i < kWidth && j < kHeight) {
            sum += from[static_cast<std::size_t>(j * kWidth + i)];
            n += 1;
          }
      to[static_cast<std::size_t>(y * kWidth + x)] = sum / (variances ? n * n : n);
    });
    std::swap(from, to);
  }
  return from;
}

/// What the documented formula makes of one pixel with one candidate.
struct Expected {
  double data[3], samples;
};
Expected expected_of(const Blend& b, int x, int y, const double (&d)[3], double square,
                     double inverse_m) {
  const RadianceBlendRule& rule = b.rule;
  const double n = b.before.samples().at(x, y);
  const double v_difference = square - (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  const double v = v_difference * n / (n + 1), u = v_difference * inverse_m;
  const double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const double b2 = std::max(0.0, d2 - double(rule.threshold) * u);
  const double s = b2 / (b2 + u);
  const double e = v / n + double(rule.spatial_samples) * ((1 - s) * (1 - s) * b2 + s * s * u);
  const double k = std::min(v / e, 63.0);
  Expected out{{}, 1 + k};
  for (int c = 0; c < 3; ++c) {
    const double h = std::max(double(b.before.data[c].at(x, y)) - s * d[c], 0.0);
    out.data[c] = (double(b.noisy[c].at(x, y)) + k * h) / (1 + k);
  }
  return out;
}

// Differences that just exceed a threshold in float shift smoothly, so that no case is left out.
TEST(RadianceBlend, AgreesWithTheDocumentedFormula) {
  Blend b;
  test::Random random(79);
  for (int c = 0; c < 3; ++c) {
    test::fill_random(b.noisy[c], random, 0, 1);
    test::fill_random(b.before.data[c], random, 0.1f, 1.2f);
  }
  test::fill_random(b.before.samples(), random, 1, 64);
  b.run(b.by_surface());

  std::vector<double> differences[3], squares(kWidth * kHeight);
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double d = double(b.before.data[c].at(x, y)) - double(b.noisy[c].at(x, y));
        differences[c].push_back(d);
        squares[static_cast<std::size_t>(y * kWidth + x)] += d * d;
      }
  const auto inverse_m = plain_window(std::vector<double>(kWidth * kHeight, 1.0), true);
  const auto square = plain_window(squares, false);
  for (auto& d : differences) d = plain_window(d, false);
  int by_history = 0;
  Blend::each([&](int x, int y) {
    const auto at = static_cast<std::size_t>(y * kWidth + x);
    const double d[3] = {differences[0][at], differences[1][at], differences[2][at]};
    const Expected want = expected_of(b, x, y, d, square[at], inverse_m[at]);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(b.now.data[c].at(x, y), want.data[c], 5e-5) << x << ", " << y;
    ASSERT_NEAR(b.now.samples().at(x, y), want.samples, 1e-3 * want.samples);
    by_history += want.samples > 10 ? 1 : 0;
  });
  EXPECT_GT(by_history, 10) << "both kinds of pixels are seen";
  EXPECT_LT(by_history, kWidth * kHeight - 20);
}

}  // namespace
}  // namespace holdfast
