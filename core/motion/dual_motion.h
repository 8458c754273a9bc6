#pragma once

#include <glm/glm.hpp>

namespace holdfast {

/// The dual motion vector of a surface that was hidden one frame ago (TRMV eq. 6, after Bowles et
/// al. 2012): its surface vector leads to `hidden_at` in the previous frame, on the occluder, which
/// is now seen at `occluder_now`. What lay as far from the occluder then as the pixel lies from it
/// now stands in for it:
///   x_{i-1} = y + (x_i - z)
/// All are pixel positions; y and the result of the previous frame, x and z of the current one.
template <class T>
glm::vec<2, T> dual_previous_pixel(const glm::vec<2, T>& pixel, const glm::vec<2, T>& hidden_at,
                                   const glm::vec<2, T>& occluder_now) {
  return hidden_at + (pixel - occluder_now);
}

}  // namespace holdfast
