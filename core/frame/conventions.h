#pragma once

#include <glm/glm.hpp>

/// The conventions that every part shares; everything else quotes this header.
///
/// image          origin top-left, x right, y down, pixel centres at +0.5, row-major
/// motion vector  pixels, previous minus current: pixel_prev = pixel + motion_px; never jittered
/// world          right-handed, metres; matrices absolute, float64, column vectors; row-major
///                wherever they are written as 16 numbers
/// camera         looks down -Z, +Y up; jitter_px = sample position minus pixel centre
/// depth          planar view-space distance in metres, > 0; sky is +inf or <= 0
/// normal         world space, unit, faces the camera
/// object id      32 bits; 0 = none; an id in no frame's table is static
/// radiance       linear, scene-referred
/// roughness      perceptual, 0..1; GGX alpha = roughness^2
namespace holdfast {

/// Pixel coordinates of a point in clip space: x = (ndc.x/2 + 1/2) W, y = (1/2 - ndc.y/2) H.
/// `clip.w` must not be zero.
template <class T>
glm::vec<2, T> pixel_from_clip(const glm::vec<4, T>& clip, T width, T height) {
  const T inv_w = T(1) / clip.w;
  return {(clip.x * inv_w * T(0.5) + T(0.5)) * width, (T(0.5) - clip.y * inv_w * T(0.5)) * height};
}

/// Normalised device coordinates of a pixel position; inverse of `pixel_from_clip` for w = 1.
template <class T>
glm::vec<2, T> ndc_from_pixel(const glm::vec<2, T>& pixel, T width, T height) {
  return {pixel.x / width * T(2) - T(1), T(1) - pixel.y / height * T(2)};
}

/// True where there is a surface: depth finite and greater than zero. NaN is no surface.
inline bool is_surface(float depth_view_m) {
  return depth_view_m > 0.0f && depth_view_m <= 3.402823466e+38f;
}

/// GGX alpha of a perceptual roughness in 0..1.
template <class T>
T ggx_alpha_from_roughness(T roughness) {
  return roughness * roughness;
}

/// A matrix from 16 row-major numbers.
inline glm::dmat4 matrix_from_row_major(const double* m) {
  glm::dmat4 out;
  for (int row = 0; row < 4; ++row)
    for (int col = 0; col < 4; ++col) out[col][row] = m[row * 4 + col];
  return out;
}

/// The 16 row-major numbers of a matrix.
inline void row_major_from_matrix(const glm::dmat4& matrix, double* m) {
  for (int row = 0; row < 4; ++row)
    for (int col = 0; col < 4; ++col) m[row * 4 + col] = matrix[col][row];
}

}  // namespace holdfast
