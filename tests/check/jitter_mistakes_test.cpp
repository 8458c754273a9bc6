#include <array>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/check/checked.h"

namespace holdfast::check::test {
namespace {

/// A floor, a wall and a ramp, cast ray by ray at jittered positions, from a camera that moves.
struct Ground {
  glm::dvec3 normal;
  double offset;  ///< normal . point
};
const std::array<Ground, 3> kGrounds{
    {{{0, 1, 0}, 0}, {{0, 0, 1}, -4}, {glm::normalize(glm::dvec3(-0.6, 1, 0.2)), -1.5}}};

Frame cast(int index, glm::dvec2 jitter) {
  Frame frame;
  frame.index = index;
  frame.camera.view_from_world =
      glm::lookAt(glm::dvec3(0.1 * index, 1.6, 3), glm::dvec3(0.2, 0.4, 0), glm::dvec3(0, 1, 0));
  frame.camera.clip_from_view = glm::perspective(0.9, double(kWidth) / kHeight, 0.1, 100.0);
  frame.camera.jitter_px = jitter;
  const ViewGeometry view(frame.camera, kWidth, kHeight);
  Plane& depth = frame.planes.add({PlaneKind::kDepth, {}}, kWidth, kHeight);
  Plane& normal = frame.planes.add({PlaneKind::kNormal, {}}, kWidth, kHeight);
  Plane& id = frame.planes.add({PlaneKind::kObjectId, {}}, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // A ray to planar depth 1, so that its parameter is planar depth.
      const glm::dvec3 ray = view.rays.position(x + 0.5 + jitter.x, y + 0.5 + jitter.y, 1.0);
      for (std::uint32_t k = 0; k < kGrounds.size(); ++k) {
        const Ground& ground = kGrounds[k];
        const double t =
            (ground.offset - glm::dot(ground.normal, view.origin)) / glm::dot(ground.normal, ray);
        float& nearest = depth.channel(0).at(x, y);
        if (!(t > 0) || (nearest > 0 && t >= double(nearest))) continue;
        nearest = float(t);
        id.ids().at(x, y) = k + 1;
        for (int c = 0; c < 3; ++c) normal.channel(c).at(x, y) = float(ground.normal[c]);
      }
    }
  return frame;
}

const std::array<glm::dvec2, 5> kJitter{
    {{0.31, -0.22}, {-0.40, 0.15}, {0.12, 0.44}, {-0.07, -0.38}, {0.45, 0.05}}};

Sequence jittered() {
  Sequence sequence;
  for (int i = 0; i < 5; ++i) sequence.frames.push_back(cast(i, kJitter[std::size_t(i)]));
  return sequence;
}

/// Moves what clip_from_view projects, pixels.
void move(Camera& camera, glm::dvec2 by) {
  camera.clip_from_view[2][0] -= by.x * 2 / kWidth;
  camera.clip_from_view[2][1] += by.y * 2 / kHeight;
}

TEST(JitterMistakes, RightJitterIsNone) {
  const Report report = jittered().check();
  EXPECT_EQ(mistakes(report), std::vector<std::string>()) << report_text(report);
  EXPECT_EQ(verdict(report, "camera"), Verdict::kOk) << report_text(report);
}

TEST(JitterMistakes, TheOppositeSignIsNamed) {
  expect_finding(jittered(), "camera.jitterPx", "jitter-opposite",
                 [](Frame& f) { f.camera.jitter_px *= -1; });
}

TEST(JitterMistakes, JitterThatTheSamplesDoNotHaveIsNamed) {
  Sequence sequence;
  for (int i = 0; i < 5; ++i) sequence.frames.push_back(cast(i, glm::dvec2(0)));
  expect_finding(sequence, "camera.jitterPx", "jitter-unused",
                 [](Frame& f) { f.camera.jitter_px = kJitter[std::size_t(f.index)]; });
}

TEST(JitterMistakes, JitterInTheProjectionIsNamed) {
  // What lies at the sample's position must be projected to the pixel's centre.
  expect_finding(jittered(), "camera.clipFromView", "jitter-in-clip",
                 [](Frame& f) { move(f.camera, -f.camera.jitter_px); });
}

TEST(JitterMistakes, JitterInTheProjectionAloneIsNamed) {
  expect_finding(jittered(), "camera.clipFromView", "jitter-in-clip", [](Frame& f) {
    move(f.camera, -f.camera.jitter_px);
    f.camera.jitter_px = {0, 0};
  });
}

TEST(JitterMistakes, MotionThatContainsJitterIsNamed) {
  Sequence sequence;
  for (int i = 0; i < 5; ++i) sequence.frames.push_back(cast(i, glm::dvec2(0)));
  add_motion(sequence);
  const Sequence still = std::move(sequence);
  sequence = jittered();
  // The grounds are smooth: motion at a jittered sample is that at the centre to 0.02 px or so.
  for (std::size_t i = 0; i < 5; ++i)
    copy_plane(still.frames[i].planes.at({PlaneKind::kMotion, {}}), sequence.frames[i].planes);
  EXPECT_EQ(mistakes(sequence.check()), std::vector<std::string>());
  expect_finding(sequence, "motion.X/Y", "motion-jittered", [](Frame& f) {
    if (f.index == 0) return;
    const glm::dvec2 now = kJitter[std::size_t(f.index)],
                     before = kJitter[std::size_t(f.index) - 1];
    change_values(f, {PlaneKind::kMotion, {}},
                  [&](float value, int, int, int c) { return value + float(now[c] - before[c]); });
  });
}

}  // namespace
}  // namespace holdfast::check::test
