#include "client/check/reading.h"

#include "core/frame/conventions.h"

namespace holdfast::check {
namespace {

Camera read_camera(Camera camera, const Reading& reading) {
  if (reading.view_inverse) camera.view_from_world = glm::inverse(camera.view_from_world);
  if (reading.clip_flipped)
    for (int c = 0; c < 4; ++c) camera.clip_from_view[c][1] *= -1;
  return camera;
}

/// Planar depth of a value of clip.z / clip.w, by the third and fourth row of clip_from_view.
double depth_from_device(double device, const glm::dmat4& clip) {
  // (a z + b) = device (c z + d) for the view-space z of the point
  const double a = clip[2][2], b = clip[3][2], c = clip[2][3], d = clip[3][3];
  return -(device * d - b) / (a - device * c);
}

/// `value` as planar depth in metres. `along` is the length of the view ray to planar depth 1.
double planar_depth(double value, DepthReading reading, const glm::dmat4& clip, double along) {
  switch (reading) {
    case DepthReading::kPlanar: return value;
    case DepthReading::kAlongRay: return value / along;
    case DepthReading::kDevice: return depth_from_device(value, clip);
    case DepthReading::kDeviceReversed: return depth_from_device(1 - value, clip);
    case DepthReading::kWindow: return depth_from_device(2 * value - 1, clip);
    case DepthReading::kWindowReversed: return depth_from_device(1 - 2 * value, clip);
    case DepthReading::kCentimetres: return value / 100;
    case DepthReading::kMillimetres: return value / 1000;
  }
  return 0;
}

}  // namespace

const std::vector<Mistake>& geometry_mistakes() {
  constexpr const char* kDepthRule = "must be the planar distance along the view axis in metres";
  constexpr const char* kNormalRule =
      "must be in world space, of unit length, on the camera's side of the surface";
  constexpr const char* kJitterRule = "must be the position of the sample minus the pixel's centre";
  static const std::vector<Mistake> mistakes{
      {[](Reading& r) { r.view_inverse = true; }, "camera.viewFromWorld", "view-inverse",
       "must take world to view space", "its inverse"},
      {[](Reading& r) { r.clip_flipped = true; }, "camera.clipFromView", "clip-flipped-y",
       "must have y upwards in clip space", "its second row negated"},
      {[](Reading& r) { r.depth = DepthReading::kAlongRay; }, "depth.Z", "depth-along-ray",
       kDepthRule, "the distance along the ray"},
      {[](Reading& r) { r.depth = DepthReading::kDevice; }, "depth.Z", "depth-device", kDepthRule,
       "device depth, clip.z / clip.w"},
      {[](Reading& r) { r.depth = DepthReading::kDeviceReversed; }, "depth.Z",
       "depth-device-reversed", kDepthRule, "reversed device depth, 1 - clip.z / clip.w"},
      {[](Reading& r) { r.depth = DepthReading::kWindow; }, "depth.Z", "depth-window", kDepthRule,
       "window depth, (clip.z / clip.w + 1) / 2"},
      {[](Reading& r) { r.depth = DepthReading::kWindowReversed; }, "depth.Z",
       "depth-window-reversed", kDepthRule, "reversed window depth, (1 - clip.z / clip.w) / 2"},
      {[](Reading& r) { r.depth = DepthReading::kCentimetres; }, "depth.Z", "depth-centimetres",
       kDepthRule, "centimetres"},
      {[](Reading& r) { r.depth = DepthReading::kMillimetres; }, "depth.Z", "depth-millimetres",
       kDepthRule, "millimetres"},
      {[](Reading& r) { r.normal = NormalReading::kView; }, "normal.X/Y/Z", "normal-view-space",
       kNormalRule, "view space"},
      {[](Reading& r) { r.normal = NormalReading::kAway; }, "normal.X/Y/Z", "normal-away",
       kNormalRule, "the opposite sign"},
      {[](Reading& r) { r.normal = NormalReading::kViewAway; }, "normal.X/Y/Z",
       "normal-view-space-away", kNormalRule, "view space with the opposite sign"},
      {[](Reading& r) { r.normal = NormalReading::kEncodedWorld; }, "normal.X/Y/Z",
       "normal-encoded", kNormalRule, "values encoded as (n + 1) / 2"},
      {[](Reading& r) { r.normal = NormalReading::kEncodedView; }, "normal.X/Y/Z",
       "normal-encoded-view-space", kNormalRule, "view space encoded as (n + 1) / 2"},
      {[](Reading& r) { r.jitter = JitterReading::kOpposite; }, "camera.jitterPx",
       "jitter-opposite", kJitterRule, "the opposite sign"},
      {[](Reading& r) { r.jitter = JitterReading::kNone; }, "camera.jitterPx", "jitter-unused",
       kJitterRule, "no jitter at all"},
  };
  return mistakes;
}

Seen::Seen(const Snapshot& frame, const Reading& reading)
    : snapshot(&frame), normal_reading_(reading.normal) {
  const Camera camera = read_camera(frame.camera, reading);
  view = ViewGeometry(camera, frame.width(), frame.height());
  world_from_view_ = glm::dmat3(glm::inverse(camera.view_from_world));
  if (reading.jitter == JitterReading::kGiven) jitter = camera.jitter_px;
  if (reading.jitter == JitterReading::kOpposite) jitter = -camera.jitter_px;
  if (const Plane* plane = frame.find(PlaneKind::kObjectId)) ids = plane->ids();

  depth = measure::Image(frame.width(), frame.height(), 1);
  const auto given = frame.planes.at({PlaneKind::kDepth, {}}).channel(0);
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      const float value = given.at(x, y);
      if (!is_surface(value)) continue;
      const glm::dvec2 p = sample(x, y);
      const double along = glm::length(view.rays.position(p.x, p.y, 1.0));
      const auto planar = static_cast<float>(
          planar_depth(static_cast<double>(value), reading.depth, camera.clip_from_view, along));
      depth.values[index(x, y)] = is_surface(planar) ? planar : 0.0f;
    }
}

glm::dvec3 Seen::normal(int x, int y) const {
  const Plane& plane = snapshot->planes.at({PlaneKind::kNormal, {}});
  glm::dvec3 n;
  for (int c = 0; c < 3; ++c) n[c] = static_cast<double>(plane.channel(c).at(x, y));
  const NormalReading r = normal_reading_;
  if (r == NormalReading::kEncodedWorld || r == NormalReading::kEncodedView) n = 2.0 * n - 1.0;
  if (r == NormalReading::kView || r == NormalReading::kViewAway ||
      r == NormalReading::kEncodedView)
    n = world_from_view_ * n;
  if (r == NormalReading::kAway || r == NormalReading::kViewAway) n = -n;
  const double length = glm::length(n);
  return length > 1e-6 && length < 1e30 ? n / length : glm::dvec3(0);
}

}  // namespace holdfast::check
