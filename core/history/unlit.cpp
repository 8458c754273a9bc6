#include "core/history/unlit.h"

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

/// One row; where it is unlit, `out` becomes what `in` has.
struct UnlitRow {
  const float* unshadowed[3];
  const float* in;  ///< null: `value` everywhere
  float value;
  int width;
  float* out;
};

HOLDFAST_INLINE void replace_unlit_body(const UnlitRow& a) {
  const float* __restrict r = a.unshadowed[0];
  const float* __restrict g = a.unshadowed[1];
  const float* __restrict b = a.unshadowed[2];
  const float* __restrict in = a.in;
  float* __restrict out = a.out;
  const float value = a.value;
#pragma GCC ivdep
  for (int x = 0; x < a.width; ++x) {
    const float there = out[x], instead = in != nullptr ? in[x] : value;
    const float without_b = b[x] <= 0.0f ? instead : there;
    const float without_g = g[x] <= 0.0f ? without_b : there;
    out[x] = r[x] <= 0.0f ? without_g : there;
  }
}
HOLDFAST_KERNEL(replace_unlit, UnlitRow)

UnlitRow row_of(const Plane& unshadowed, int y) {
  return {
      {unshadowed.channel(0).row(y), unshadowed.channel(1).row(y), unshadowed.channel(2).row(y)},
      nullptr,
      0.0f,
      unshadowed.width(),
      nullptr};
}

}  // namespace

void set_unlit(const Plane& unshadowed, float value, ChannelView<float> samples) noexcept {
  for_each_row(unshadowed.height(), [&](int y) {
    UnlitRow row = row_of(unshadowed, y);
    row.value = value;
    row.out = samples.row(y);
    replace_unlit(row);
  });
}

void pass_unlit(const Plane& unshadowed, ChannelView<const float> noisy,
                ChannelView<float> out) noexcept {
  for_each_row(unshadowed.height(), [&](int y) {
    UnlitRow row = row_of(unshadowed, y);
    row.in = noisy.row(y);
    row.out = out.row(y);
    replace_unlit(row);
  });
}

}  // namespace holdfast
