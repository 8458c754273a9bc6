#pragma once

#include <glm/glm.hpp>

#include "core/frame/frame.h"

namespace holdfast {

/// Positions of pixels relative to the camera, in world axes and metres, as an affine function of
/// the pixel position p and the planar view depth d:
///   X(p, d) = (near_weight + far_weight d) (p.x lateral_x + p.y lateral_y + lateral_0) + d forward
/// Perspective: near_weight 0, far_weight 1. Orthographic: near_weight 1, far_weight 0.
/// World positions are X + origin; leaving the origin out keeps float precision far from it.
template <class T>
struct PixelRays {
  glm::vec<3, T> lateral_0{0}, lateral_x{0}, lateral_y{0}, forward{0};
  T near_weight = 0, far_weight = 1;

  glm::vec<3, T> position(T px, T py, T depth_view_m) const {
    const T scale = near_weight + far_weight * depth_view_m;
    return scale * (lateral_0 + px * lateral_x + py * lateral_y) + depth_view_m * forward;
  }

  template <class U>
  PixelRays<U> cast() const {
    return {glm::vec<3, U>(lateral_0),
            glm::vec<3, U>(lateral_x),
            glm::vec<3, U>(lateral_y),
            glm::vec<3, U>(forward),
            U(near_weight),
            U(far_weight)};
  }
};

/// What the core derives from a camera and an image size, in double.
struct ViewGeometry {
  int width = 0, height = 0;
  glm::dvec3 origin{0};               ///< camera position in the world, metres
  PixelRays<double> rays;             ///< of unjittered pixel positions
  glm::dmat4 pixel_from_relative{1};  ///< camera-relative point -> (x w, y w, depth, w)
  double pixel_angle = 0;             ///< footprint of a pixel at depth 1 m (perspective), metres

  ViewGeometry() = default;
  /// Throws InputError for a matrix that is not finite or not invertible.
  ViewGeometry(const Camera& camera, int image_width, int image_height);

  /// The same view in pixels of twice the size, enough of them to cover the image: pixel (X, Y) of
  /// the result covers (2X, 2Y) to (2X + 1, 2Y + 1).
  ViewGeometry halved() const;
};

/// pixel_from_X for pixels of twice the size.
template <class T>
glm::mat<4, 4, T> halved_pixels(glm::mat<4, 4, T> pixel_from) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 2; ++r) pixel_from[c][r] *= T(0.5);
  return pixel_from;
}

/// A projected point: pixel position and planar view depth in metres. Behind the camera, or beyond
/// 1e9 pixels, x and y are 0 and `in_front` is false.
template <class T>
struct PixelPoint {
  T x, y, depth;
  bool in_front;
};

/// Projects a homogeneous camera-relative point (w = 1) or direction (w = 0) with
/// `ViewGeometry::pixel_from_relative`.
template <class T>
PixelPoint<T> project(const glm::mat<4, 4, T>& pixel_from_relative, const glm::vec<4, T>& point) {
  const glm::vec<4, T> h = pixel_from_relative * point;
  const bool in_front = h.w > T(0) && h.z > T(0);
  const T x = in_front ? h.x / h.w : T(0), y = in_front ? h.y / h.w : T(0);
  const T reach = x * x + y * y;  // also keeps overflow from passing for a position
  return reach < T(1e18) ? PixelPoint<T>{x, y, h.z, in_front} : PixelPoint<T>{0, 0, h.z, false};
}

/// The same for a point.
template <class T>
PixelPoint<T> project(const glm::mat<4, 4, T>& pixel_from_relative, const glm::vec<3, T>& point) {
  return project(pixel_from_relative, glm::vec<4, T>(point, T(1)));
}

}  // namespace holdfast
