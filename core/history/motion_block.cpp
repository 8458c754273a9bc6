#include "core/history/motion_block.h"

#include "core/kernels/variants.h"

namespace holdfast {
namespace {

HOLDFAST_INLINE void motion_of_block_body(const MotionBlock& a) {
  const float* __restrict px = a.x;
  const float* __restrict py = a.y;
  const float* __restrict known = a.known;
  float* __restrict motion_x = a.motion_x;
  float* __restrict motion_y = a.motion_y;
  const float first_x = a.first_x, row = a.row;
  int stays = 0;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) {
    const float x = px[i] - (static_cast<float>(i) + first_x), y = py[i] - row;
    motion_x[i] = known[i] != 0.0f ? x : 0.0f;
    motion_y[i] = known[i] != 0.0f ? y : 0.0f;
    const int level = y == 0.0f ? 1 : 0, still = x == 0.0f ? level : 0;
    stays |= known[i] != 0.0f ? still : 0;
  }
  if (a.any_stays != nullptr) *a.any_stays = stays;
}
HOLDFAST_KERNEL(motion_of_block, MotionBlock)

}  // namespace

void write_motion(const MotionBlock& block) noexcept { motion_of_block(block); }

}  // namespace holdfast
