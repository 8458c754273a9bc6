#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/check/check.h"
#include "client/scenes/builtin.h"
#include "client/scenes/renderer.h"
#include "core/frame/conventions.h"
#include "core/frame/scene_motion.h"

namespace holdfast::check::test {

inline constexpr int kWidth = 96, kHeight = 54;

inline void copy_plane(const Plane& from, PlaneSet& to) {
  Plane& plane = to.add(from.id(), from.width(), from.height());
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      std::copy_n(from.words(c).row(y), plane.width(), plane.words(c).row(y));
}

/// A sequence in memory.
struct Sequence {
  std::vector<Light> lights;
  std::vector<Frame> frames;

  static Frame copy(const Frame& frame) {
    Frame out{frame.index, frame.cut, frame.camera, frame.objects, frame.lights, {}};
    for (const Plane& plane : frame.planes) copy_plane(plane, out.planes);
    return out;
  }
  Sequence copy() const {
    Sequence out{lights, {}};
    for (const Frame& frame : frames) out.frames.push_back(copy(frame));
    return out;
  }
  Report check() const {
    return check_frames({frames.size(), lights, [this](std::size_t i) { return copy(frames[i]); }});
  }
};

/// The motion plane that a renderer would send: by the matrices of the frames, not by the check.
inline void add_motion(Sequence& sequence) {
  SceneMotion scene;
  for (Frame& frame : sequence.frames) {
    scene.advance(frame, kWidth, kHeight, sequence.lights);
    Plane& motion = frame.planes.add({PlaneKind::kMotion, {}}, kWidth, kHeight);
    const auto depth = frame.planes.at({PlaneKind::kDepth, {}}).channel(0);
    const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const float px = float(x) + 0.5f, py = float(y) + 0.5f;
        if (!is_surface(depth.at(x, y))) continue;
        const glm::vec3 point = scene.view().rays.cast<float>().position(px, py, depth.at(x, y));
        const auto before = project(scene.object(scene.slot_of(ids.at(x, y))).prev_pixel, point);
        motion.channel(0).at(x, y) = before.x - px;
        motion.channel(1).at(x, y) = before.y - py;
      }
  }
}

inline Sequence rendered(const char* scene, int frames) {
  scenes::RenderSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  scenes::Renderer renderer(scenes::builtin_scene(scene), settings);
  Sequence sequence{renderer.lights(), {}};
  for (int i = 0; i < frames; ++i) sequence.frames.push_back(renderer.frame(i));
  return sequence;
}

/// Four frames of the built-in room, where camera, light and an object move, with motion.
inline const Sequence& room() {
  static const Sequence sequence = [] {
    Sequence made = rendered("room", 4);
    add_motion(made);
    return made;
  }();
  return sequence;
}

/// The names of the mistakes that were found, in their order.
inline std::vector<std::string> mistakes(const Report& report) {
  std::vector<std::string> names;
  for (const Finding& finding : report.findings) names.push_back(finding.mistake);
  return names;
}

inline Verdict verdict(const Report& report, const std::string& check) {
  for (const Line& line : report.lines)
    if (line.check == check) return line.verdict;
  ADD_FAILURE() << "no line about " << check;
  return Verdict::kNoEvidence;
}

/// `damage` done to every frame of `good` makes exactly this finding.
inline void expect_finding(const Sequence& good, const std::string& thing,
                           const std::string& mistake, const std::function<void(Frame&)>& damage) {
  Sequence bad = good.copy();
  for (Frame& frame : bad.frames) damage(frame);
  const Report report = bad.check();
  EXPECT_EQ(mistakes(report), std::vector{mistake}) << report_text(report);
  if (report.findings.empty()) return;
  EXPECT_EQ(report.findings[0].thing, thing);
  EXPECT_GT(report.findings[0].pixels, 0);
  EXPECT_GT(report.findings[0].share, 0);
}

/// Calls `change(value, x, y, c)` for every value of a plane of reals.
inline void change_values(Frame& frame, PlaneId id,
                          const std::function<float(float, int, int, int)>& change) {
  Plane& plane = *frame.planes.find(id);
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        float& value = plane.channel(c).at(x, y);
        value = change(value, x, y, c);
      }
}

/// Replaces the three channels of a plane at each pixel.
inline void change_vectors(Frame& frame, PlaneKind kind,
                           const std::function<glm::dvec3(glm::dvec3)>& change) {
  Plane& plane = *frame.planes.find({kind, {}});
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      glm::dvec3 v;
      for (int c = 0; c < 3; ++c) v[c] = double(plane.channel(c).at(x, y));
      v = change(v);
      for (int c = 0; c < 3; ++c) plane.channel(c).at(x, y) = float(v[c]);
    }
}

}  // namespace holdfast::check::test
