#include "client/measure/convolve.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/kernels/parallel.h"

namespace holdfast::measure {
namespace {

/// Pixels of one row that are summed together: their sums stay in registers over all taps.
constexpr int kBlock = 32;

/// out[x] = sum_i taps[i] * rows[i][x] for a whole row; the loops that the compiler vectorises.
void sum_rows(std::span<const float* const> rows, std::span<const float> taps, int width,
              float* out) noexcept {
  int start = 0;
  for (; start + kBlock <= width; start += kBlock) {
    float sums[kBlock] = {};
    for (std::size_t i = 0; i < taps.size(); ++i) {
      const float tap = taps[i];
      const float* in = rows[i] + start;
      for (int x = 0; x < kBlock; ++x) sums[x] += tap * in[x];
    }
    std::copy_n(sums, kBlock, out + start);
  }
  for (int x = start; x < width; ++x) {
    float sum = 0;
    for (std::size_t i = 0; i < taps.size(); ++i) sum += taps[i] * rows[i][x];
    out[x] = sum;
  }
}

const float* row_at(const float* image, int width, int y) noexcept {
  return image + static_cast<std::ptrdiff_t>(y) * width;
}

/// One row with `radius` border values on each side.
void pad_row(const float* in, int width, int radius, Border border, float* padded) {
  const bool zero = border == Border::kZero;
  std::fill_n(padded, radius, zero ? 0.0f : in[0]);
  std::copy_n(in, width, padded + radius);
  std::fill_n(padded + radius + width, radius, zero ? 0.0f : in[width - 1]);
}

}  // namespace

void convolve(const float* in, int width, int height, std::span<const float> row_taps,
              std::span<const float> column_taps, Border border, float* out) {
  std::vector<float> between(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int row_radius = static_cast<int>(row_taps.size() / 2);
  const int column_radius = static_cast<int>(column_taps.size() / 2);

  for_each_row(height, [&](int y) {
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * row_radius));
    pad_row(row_at(in, width, y), width, row_radius, border, padded.data());
    std::vector<const float*> rows;
    for (std::size_t i = 0; i < row_taps.size(); ++i) rows.push_back(padded.data() + i);
    sum_rows(rows, row_taps, width, between.data() + static_cast<std::ptrdiff_t>(y) * width);
  });
  const std::vector<float> zeros(static_cast<std::size_t>(width));
  for_each_row(height, [&](int y) {
    std::vector<const float*> rows;
    for (int source = y - column_radius; source <= y + column_radius; ++source) {
      const bool outside = source < 0 || source >= height;
      rows.push_back(outside && border == Border::kZero
                         ? zeros.data()
                         : row_at(between.data(), width, std::clamp(source, 0, height - 1)));
    }
    sum_rows(rows, column_taps, width, out + static_cast<std::ptrdiff_t>(y) * width);
  });
}

}  // namespace holdfast::measure
