#pragma once

#include <vector>

#include "core/history/glossy_history.h"
#include "tests/core/two_frames.h"

namespace holdfast::test {

inline constexpr std::uint32_t kMirror = 1, kThing = 2;

inline Card mirror_card() {
  const glm::dmat4 flat = glm::rotate(glm::dmat4(1), -1.45, glm::dvec3(1, 0, 0));
  return {kMirror, {-40, -40}, {40, 40}, glm::translate(glm::dmat4(1), {0, -1, -5}) * flat};
}
inline Card thing_card() {
  return {kThing, {-30, -30}, {30, 30}, glm::translate(glm::dmat4(1), {0, 0, -9})};
}

/// A mirror, tilted like a floor, and what it shows: one ray a pixel in the mirror's direction, or
/// to the sky where nothing is.
struct Reflections : TwoFrames {
  static constexpr int kWidth = 128, kHeight = 72;
  Plane direction{{PlaneKind::kGlossyDirection, {}}, kWidth, kHeight};
  Plane distance{{PlaneKind::kGlossyHitDistance, {}}, kWidth, kHeight};
  Plane id{{PlaneKind::kGlossyHitId, {}}, kWidth, kHeight};
  EffectHistory out{kWidth, kHeight};

  explicit Reflections(bool with_thing = true)
      : TwoFrames(
            kWidth, kHeight,
            with_thing ? std::vector{mirror_card(), thing_card()} : std::vector{mirror_card()}) {
    for (const std::uint32_t object : {kMirror, kThing})
      before.objects[object] = scene.objects[object] = glm::dmat4(1);
  }
  void render(float roughness = 0.0f) {
    TwoFrames::render();
    for (Guides* guides : {&previous, &now}) {
      guides->roughness = Channels<float>(kWidth, kHeight, 1);
      fill(guides->roughness[0], roughness);
    }
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) reflect(x, y);
  }
  void reflect(int x, int y) {
    for (int c = 0; c < 3; ++c) direction.channel(c).at(x, y) = 0.0f;
    distance.channel(0).at(x, y) = 0.0f;
    id.ids().at(x, y) = 0;
    if (now.id[0].at(x, y) != kMirror) return;
    const glm::dvec3 point(now.position_at(x, y)), normal(now.normal_at(x, y));
    const glm::dvec3 along = glm::reflect(glm::normalize(point), normal);
    const CardHit hit = scene.trace(now.view.origin + point, along, kMirror);
    for (int c = 0; c < 3; ++c) direction.channel(c).at(x, y) = static_cast<float>(along[c]);
    distance.channel(0).at(x, y) = static_cast<float>(hit.distance);
    id.ids().at(x, y) = hit.id;
  }
  void run(GlossyRule rule, FrameKey key = {}) {
    trace_glossy_history(frames(), {&direction, &distance, &id}, rule, key, out);
  }
  bool sampled(int x, int y) const { return now.id[0].at(x, y) == kMirror; }
  glm::dvec2 vector(int x, int y) const { return {out.motion[0].at(x, y), out.motion[1].at(x, y)}; }
  bool found(int x, int y) const { return out.taps[0].at(x, y).any(); }
  /// Calls body(x, y) for the pixels of the mirror that have history, and returns how many.
  template <class Body>
  int for_each_found(const Body& body) const {
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!sampled(x, y) || !found(x, y)) continue;
        body(x, y);
        ++count;
      }
    return count;
  }
  /// All move: camera, mirror and what it shows.
  void move_everything() {
    camera = perspective_camera(kWidth, kHeight, {0.05, 0.02, -0.03}, {0.01, 0.005, -1});
    scene.objects[kMirror] = glm::translate(glm::rotate(glm::dmat4(1), 0.01, glm::dvec3(1, 0.5, 0)),
                                            glm::dvec3(0.02, 0.03, 0));
    scene.objects[kThing] = glm::translate(glm::rotate(glm::dmat4(1), 0.02, glm::dvec3(0, 0.4, 1)),
                                           glm::dvec3(-0.2, 0.1, 0.1));
  }
};

}  // namespace holdfast::test
