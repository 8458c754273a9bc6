#include "client/scenes/motion.h"

#include <algorithm>
#include <cmath>

namespace holdfast::scenes {
namespace {

/// Brings a time into the span of the keys by the rule of repetition.
double wrap(double frame, double first, double last, Repeat repeat) {
  const double span = last - first;
  if (span <= 0.0 || repeat == Repeat::kHold) return std::clamp(frame, first, last);
  const double period = repeat == Repeat::kMirror ? 2.0 * span : span;
  double phase = std::fmod(frame - first, period);
  if (phase < 0.0) phase += period;
  return first + (phase > span ? period - phase : phase);
}

}  // namespace

glm::dmat4 Transform::matrix() const {
  glm::dmat4 m = glm::mat4_cast(rotation);
  m[0] *= scale.x;
  m[1] *= scale.y;
  m[2] *= scale.z;
  m[3] = glm::dvec4(translation, 1.0);
  return m;
}

Transform look_at(const glm::dvec3& eye, const glm::dvec3& target) {
  glm::dvec3 way = target - eye;
  if (!std::isnormal(glm::dot(way, way)))
    way /= std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
  const glm::dvec3 forward = glm::normalize(way);
  const glm::dvec3 up = std::abs(forward.y) > 0.9999 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  Transform out;
  out.translation = eye;
  out.rotation = glm::normalize(glm::quatLookAt(forward, up));
  return out;
}

Transform interpolate(const Transform& a, const Transform& b, double t) {
  Transform out;
  out.translation = glm::mix(a.translation, b.translation, t);
  out.rotation = glm::normalize(glm::slerp(a.rotation, b.rotation, t));
  out.scale = glm::mix(a.scale, b.scale, t);
  return out;
}

Transform Motion::at(double frame) const {
  const double time = wrap(frame, keys.front().frame, keys.back().frame, repeat);
  const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, const Key& key) { return t < key.frame; });
  if (after == keys.begin()) return keys.front().transform;
  const Key& a = *(after - 1);
  if (after == keys.end() || after->jump) return a.transform;
  return interpolate(a.transform, after->transform, (time - a.frame) / (after->frame - a.frame));
}

bool Motion::jumps(double from, double to) const {
  return std::any_of(keys.begin(), keys.end(), [&](const Key& key) {
    return key.jump && key.frame > from && key.frame <= to;
  });
}

}  // namespace holdfast::scenes
