#include "core/shading/ltc.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "core/kernels/math.h"
#include "core/shading/ggx.h"
#include "core/shading/ltc_layout.h"

namespace holdfast {
namespace {

constexpr float kTable[] = {
#include "core/shading/generated/ltc_table.inc"
};
static_assert(std::size(kTable) == std::size_t{kLtcSide} * kLtcSide * kLtcEntries);

/// A position on one axis of the table: the cell below it and how far it is to the next.
template <class T>
struct AxisPosition {
  std::size_t cell;
  T fraction;

  /// `x` in 0..1.
  explicit AxisPosition(T x) {
    const T at = x * T(kLtcSide - 1);
    cell = static_cast<std::size_t>(min_of(at, T(kLtcSide - 2)));
    fraction = at - static_cast<T>(cell);
  }
};

template <class T>
std::array<T, kLtcEntries> interpolated(T roughness, T u) {
  const AxisPosition<T> i(roughness), j(u);
  const float* low = kTable + (i.cell * kLtcSide + j.cell) * kLtcEntries;
  const float* high = low + kLtcSide * kLtcEntries;
  std::array<T, kLtcEntries> out;
  for (std::size_t k = 0; k < kLtcEntries; ++k) {
    const auto mix = [&](const float* row) {
      return T(row[k]) + j.fraction * (T(row[k + kLtcEntries]) - T(row[k]));
    };
    out[k] = mix(low) + i.fraction * (mix(high) - mix(low));
  }
  return out;
}

}  // namespace

template <class T>
LtcLobe<T> ltc_lobe(T roughness, T cos_view) {
  const T r = roughness > T(0) ? min_of(roughness, T(1)) : T(0);
  const T c = cos_view > T(kLeastCosine) ? min_of(cos_view, T(1)) : T(kLeastCosine);
  const T s = std::sqrt(T(1) - c * c), alpha = lobe_alpha(r);
  const std::array<T, kLtcEntries> e = interpolated(r, std::sqrt(T(1) - c));
  const T zx = alpha * e[kLtcZx], zz = alpha * e[kLtcZz];
  LtcLobe<T> lobe;
  // S R^T, columns first; R's columns are (c, 0, s), y, (-s, 0, c).
  const glm::mat<3, 3, T> stretch(e[kLtcXx], T(0), zx, T(0), T(1), T(0), e[kLtcXz], T(0), zz);
  const glm::mat<3, 3, T> mirror_from_tangent(c, T(0), -s, T(0), T(1), T(0), s, T(0), c);
  lobe.cosine_from_lobe = stretch * mirror_from_tangent;
  // In the cosine's space the surface is a plane through the origin whose normal is the last row of
  // M, here up to a factor; of a clamped cosine, (1 + n.z)/2 lies on the normal's side.
  const T xx = lobe.cosine_from_lobe[0][0], xz = lobe.cosine_from_lobe[0][2];
  lobe.above_horizon = T(0.5) * (T(1) + xx / std::sqrt(xx * xx + xz * xz));
  lobe.magnitude = e[kLtcMagnitude];
  lobe.fresnel = e[kLtcFresnel];
  return lobe;
}

template LtcLobe<float> ltc_lobe(float, float);
template LtcLobe<double> ltc_lobe(double, double);

}  // namespace holdfast
