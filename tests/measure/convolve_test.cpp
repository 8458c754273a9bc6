#include "client/measure/convolve.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "tests/measure/test_images.h"

namespace holdfast::measure {
namespace {

/// The definition, in double precision.
double direct(const Image& in, int x, int y, std::span<const float> row,
              std::span<const float> column, Border border) {
  const int r = static_cast<int>(row.size() / 2), s = static_cast<int>(column.size() / 2);
  double sum = 0;
  for (int j = -s; j <= s; ++j)
    for (int i = -r; i <= r; ++i) {
      const bool outside = x + i < 0 || x + i >= in.width || y + j < 0 || y + j >= in.height;
      if (outside && border == Border::kZero) continue;
      const int u = std::clamp(x + i, 0, in.width - 1), v = std::clamp(y + j, 0, in.height - 1);
      sum += static_cast<double>(row[static_cast<std::size_t>(i + r)]) *
             static_cast<double>(column[static_cast<std::size_t>(j + s)]) *
             static_cast<double>(in.values[static_cast<std::size_t>(v * in.width + u)]);
    }
  return sum;
}

TEST(Convolve, FollowsItsDefinitionForEverySize) {
  const std::array<float, 5> row{0.1f, -0.7f, 0.5f, 0.3f, 0.9f};
  const std::array<float, 3> column{0.25f, -0.5f, 2.0f};
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 9}, {31, 2}, {32, 5}, {33, 40}, {97, 3}})
    for (const Border border : {Border::kReplicate, Border::kZero}) {
      const Image in = test::Noise(3).image(width, height, 1);
      Image out(width, height, 1);
      convolve(in.values.data(), width, height, row, column, border, out.values.data());
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_NEAR(static_cast<double>(out.values[static_cast<std::size_t>(y * width + x)]),
                      direct(in, x, y, row, column, border), 1e-6)  // 15 products of size 1
              << width << "x" << height << " at " << x << "," << y;
    }
}

TEST(Convolve, MayWriteOverItsInput) {
  const std::array<float, 3> taps{0.25f, 0.5f, 0.25f};
  Image in = test::Noise(3).image(40, 12, 1), out(40, 12, 1);
  convolve(in.values.data(), 40, 12, taps, taps, Border::kReplicate, out.values.data());
  convolve(in.values.data(), 40, 12, taps, taps, Border::kReplicate, in.values.data());
  EXPECT_EQ(in.values, out.values);
}

}  // namespace
}  // namespace holdfast::measure
