#include "client/measure/static_motion.h"

#include "core/frame/conventions.h"

namespace holdfast::measure {

StaticMotion static_motion(const Frame& frame, const SceneMotion& scene) {
  const Plane& depth = frame.planes.at({PlaneKind::kDepth, {}});
  const Plane* ids = frame.planes.find({PlaneKind::kObjectId, {}});
  const Plane* motion = frame.planes.find({PlaneKind::kMotion, {}});
  const int width = depth.width(), height = depth.height();
  StaticMotion out{Image(width, height, 2), Image(width, height, 2), {}};
  out.shown.resize(out.given.pixels());
  const PixelRays<float> rays = scene.view().rays.cast<float>();
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i) {
      const float d = depth.channel(0).at(x, y);
      if (!is_surface(d)) continue;
      const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
      const glm::vec3 point = rays.position(px, py, d);
      const auto put = [&](Image& image, const ObjectMotion<float>& by) {
        const PixelPoint<float> before = project(by.prev_pixel, point);
        image.channel(0)[i] = before.in_front ? before.x - px : 0;
        image.channel(1)[i] = before.in_front ? before.y - py : 0;
        return before.in_front;
      };
      bool shown = put(out.at_rest, scene.object(0));
      if (motion)
        for (int c = 0; c < 2; ++c) out.given.channel(c)[i] = motion->channel(c).at(x, y);
      else
        shown = put(out.given, scene.object(ids ? scene.slot_of(ids->ids().at(x, y)) : 0)) && shown;
      out.shown[i] = shown ? 1 : 0;
    }
  return out;
}

Image motion_difference(const StaticMotion& motion) {
  Image out = motion.given;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] -= motion.at_rest.values[i];
  return out;
}

}  // namespace holdfast::measure
