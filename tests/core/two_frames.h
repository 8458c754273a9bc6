#pragma once

#include <limits>
#include <vector>

#include "core/history/frame_pair.h"
#include "tests/core/small_world.h"

namespace holdfast::test {

/// A rectangle in the plane z = 0 of its object's own space.
struct Card {
  std::uint32_t id;
  glm::dvec2 low, high;
  glm::dmat4 local{1};  ///< to the object's space
};

struct CardHit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t id = 0;
  glm::dvec3 point{0}, normal{0};  ///< world; the normal faces the ray
};

/// Objects of cards at one moment, traced in double.
struct CardScene {
  std::vector<Card> cards;
  TransformTable objects;

  glm::dmat4 world_from_object(std::uint32_t id) const {
    const auto it = objects.find(id);
    return it == objects.end() ? glm::dmat4(1) : it->second;
  }
  CardHit trace(const glm::dvec3& from, const glm::dvec3& along, std::uint32_t except = 0) const {
    CardHit best;
    for (const Card& card : cards) {
      if (card.id == except) continue;
      const glm::dmat4 world = world_from_object(card.id) * card.local, local = glm::inverse(world);
      const glm::dvec3 o(local * glm::dvec4(from, 1)), d(local * glm::dvec4(along, 0));
      const double t = -o.z / d.z;
      const glm::dvec2 at = glm::dvec2(o) + t * glm::dvec2(d);
      if (!(t > 0 && t < best.distance) || at.x < card.low.x || at.y < card.low.y ||
          at.x > card.high.x || at.y > card.high.y)
        continue;
      const glm::dvec3 normal = glm::normalize(glm::dvec3(world[2]));
      best = {t, card.id, from + t * along, glm::dot(normal, along) < 0 ? normal : -normal};
    }
    return best;
  }
};

/// Two frames of cards as a renderer would send them, and the guides that the core makes of them.
struct TwoFrames {
  int width, height;
  CardScene before, scene;
  Guides previous, now;
  SceneMotion motion;

  TwoFrames(int w, int h, const std::vector<Card>& cards) : width(w), height(h) {
    before.cards = scene.cards = cards;
    camera_before = camera = perspective_camera(w, h);
  }
  Camera camera_before, camera;

  void render() {
    Frame frame;
    frame.camera = camera_before;
    frame.objects = before.objects;
    motion.advance(frame, width, height, {});
    frame.camera = camera;
    frame.objects = scene.objects;
    motion.advance(frame, width, height, {});
    previous = seen(before, camera_before);
    now = seen(scene, camera);
  }
  FramePair frames() const { return {now, previous, motion}; }

  Guides seen(const CardScene& cards, const Camera& from) const {
    Guides guides = empty_guides(from, width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec3 along = guides.view.rays.position(x + 0.5, y + 0.5, 1.0);
        const CardHit hit = cards.trace(guides.view.origin, along);
        if (hit.id != 0)
          set_pixel(guides, x, y, static_cast<float>(hit.distance), glm::vec3(hit.normal), hit.id);
      }
    return guides;
  }
};

}  // namespace holdfast::test
