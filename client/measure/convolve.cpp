#include "client/measure/convolve.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace holdfast::measure {
namespace {

constexpr int kRowsPerTask = 16;

/// out[x] += tap * in[x]; the loop that the compiler vectorises.
void add_scaled(const float* __restrict in, float tap, int count, float* __restrict out) noexcept {
  for (int x = 0; x < count; ++x) out[x] += tap * in[x];
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

template <class Row>
void for_rows(int height, Row row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsPerTask), [&](const auto& range) {
    for (int y = range.begin(); y != range.end(); ++y) row(y);
  });
}

}  // namespace

void convolve(const float* in, int width, int height, std::span<const float> row_taps,
              std::span<const float> column_taps, Border border, float* out) {
  std::vector<float> between(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int row_radius = static_cast<int>(row_taps.size() / 2);
  const int column_radius = static_cast<int>(column_taps.size() / 2);

  for_rows(height, [&](int y) {
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * row_radius));
    pad_row(row_at(in, width, y), width, row_radius, border, padded.data());
    float* target = between.data() + static_cast<std::ptrdiff_t>(y) * width;
    for (std::size_t i = 0; i < row_taps.size(); ++i)
      add_scaled(padded.data() + i, row_taps[i], width, target);
  });
  for_rows(height, [&](int y) {
    float* target = out + static_cast<std::ptrdiff_t>(y) * width;
    std::fill_n(target, width, 0.0f);
    for (int j = -column_radius; j <= column_radius; ++j) {
      const int source = border == Border::kReplicate ? std::clamp(y + j, 0, height - 1) : y + j;
      if (source >= 0 && source < height)
        add_scaled(row_at(between.data(), width, source),
                   column_taps[static_cast<std::size_t>(j + column_radius)], width, target);
    }
  });
}

}  // namespace holdfast::measure
