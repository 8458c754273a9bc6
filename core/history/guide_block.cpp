#include "core/history/guide_block.h"

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr float kSteps = 32767.0f;         // of a coordinate of the square, from 0 to 1
constexpr float kRoughnessSteps = 255.0f;  // from 0 to 1

HOLDFAST_INLINE float with_sign_of(float magnitude, float sign) {
  return __builtin_copysignf(magnitude, sign);
}

HOLDFAST_INLINE std::uint32_t step_of(float coordinate) {
  const float scaled = coordinate * kSteps;
  const auto step = static_cast<std::int32_t>(scaled + with_sign_of(0.5f, scaled));
  return static_cast<std::uint32_t>(step) & 0xffffu;
}

HOLDFAST_INLINE void normals_body(const GuidePacking& a) {
  const float* __restrict nx = a.normal[0];
  const float* __restrict ny = a.normal[1];
  const float* __restrict nz = a.normal[2];
  std::uint32_t* __restrict out = a.packed_normal;
  const int count = a.count;
  for (int i = 0; i < count; ++i) {
    const float x = nx[i], y = ny[i], z = nz[i];
    const float reach = max_of(abs_of(x) + abs_of(y) + abs_of(z), 1e-30f);
    const float u = x / reach, v = y / reach;
    // The lower half is folded outwards, over the edges of the upper one.
    const float folded_u = with_sign_of(1.0f - abs_of(v), u);
    const float folded_v = with_sign_of(1.0f - abs_of(u), v);
    out[i] = step_of(z < 0.0f ? folded_u : u) | (step_of(z < 0.0f ? folded_v : v) << 16);
  }
}

HOLDFAST_INLINE void roughness_body(const GuidePacking& a) {
  const float* __restrict in = a.roughness;
  std::uint8_t* __restrict out = a.packed_roughness;
  const int count = a.count;
  for (int i = 0; i < count; ++i) {
    const float step = in[i] * kRoughnessSteps + 0.5f;
    const float inside = min_of(max_of(step, 1.0f), kRoughnessSteps - 1.0f);
    const float kept = in[i] > 0.0f && in[i] < 1.0f ? inside : step;
    out[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(kept));
  }
}

HOLDFAST_INLINE void unpack_normals_body(const GuideUnpacking& a) {
  const float* __restrict depth = a.depth;
  const std::uint32_t* __restrict in = a.packed_normal;
  float* __restrict nx = a.normal[0];
  float* __restrict ny = a.normal[1];
  float* __restrict nz = a.normal[2];
  for (int i = 0; i < a.count; ++i) {
    const float u = static_cast<float>(static_cast<std::int32_t>(in[i] << 16) >> 16) / kSteps;
    const float v = static_cast<float>(static_cast<std::int32_t>(in[i]) >> 16) / kSteps;
    const float z = 1.0f - abs_of(u) - abs_of(v);
    const float fold = max_of(-z, 0.0f);
    const float x = u - with_sign_of(fold, u), y = v - with_sign_of(fold, v);
    const float length = __builtin_sqrtf(x * x + y * y + z * z);
    const float scale = depth[i] > 0.0f ? 1.0f / length : 0.0f;
    nx[i] = x * scale;
    ny[i] = y * scale;
    nz[i] = z * scale;
  }
}

HOLDFAST_INLINE void unpack_roughness_body(const GuideUnpacking& a) {
  const std::uint8_t* __restrict in = a.packed_roughness;
  float* __restrict out = a.roughness;
  for (int i = 0; i < a.count; ++i) out[i] = static_cast<float>(in[i]) / kRoughnessSteps;
}

HOLDFAST_KERNEL(normals, GuidePacking)
HOLDFAST_KERNEL(roughness, GuidePacking)
HOLDFAST_KERNEL(unpack_normals, GuideUnpacking)
HOLDFAST_KERNEL(unpack_roughness, GuideUnpacking)

}  // namespace

void pack_guides(const GuidePacking& row) noexcept {
  normals(row);
  if (row.roughness != nullptr) roughness(row);
}

void unpack_guides(const GuideUnpacking& row) noexcept {
  unpack_normals(row);
  if (row.roughness != nullptr) unpack_roughness(row);
}

}  // namespace holdfast
