#pragma once

#include <cstdint>

namespace holdfast {

/// Motion vectors of neighbouring pixels of a row, from where each is to where it was.
struct MotionBlock {
  const float *x, *y;  ///< previous pixel positions
  const float* known;  ///< 0: not known; of these the motion is 0
  int count;
  float first_x, row;          ///< pixel position of the first one's centre
  float *motion_x, *motion_y;  ///< written, pixels
  std::int32_t* any_stays;     ///< written: 1 if any that is known has not moved; may be null
};
void write_motion(const MotionBlock& block) noexcept;

}  // namespace holdfast
