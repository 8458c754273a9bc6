#include "core/history/glossy_history.h"

#include <cstring>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "core/frame/conventions.h"
#include "core/motion/glossy_motion.h"
#include "tests/core/mirror_oracle.h"
#include "tests/core/reflection_world.h"

namespace holdfast {
namespace {

constexpr int kWidth = test::Reflections::kWidth, kHeight = test::Reflections::kHeight;
using test::kMirror, test::kThing, test::Reflections;

// The same point of the reflected object, carried back, and the previous frame's own rays.
TEST(GlossyHistory, OfAMirrorLeadsToThePixelThatSawTheSamePoint) {
  Reflections r;
  r.move_everything();
  r.render();
  r.run(GlossyRule::kSpecular);
  const glm::dmat4 thing = glm::inverse(r.scene.objects[kThing]);
  const glm::dmat4 mirror = glm::inverse(r.scene.objects[kMirror]);
  int compared = 0;
  const int found = r.for_each_found([&](int x, int y) {
    if (x % 16 != 0 || y % 8 != 0 || r.id.ids().at(x, y) != kThing) return;
    const glm::dvec3 point = glm::dvec3(r.now.position_at(x, y));
    const glm::dvec3 along = glm::reflect(glm::normalize(point), glm::dvec3(r.now.normal_at(x, y)));
    const glm::dvec3 hit =
        r.now.view.origin + point + double(r.distance.channel(0).at(x, y)) * along;
    const glm::dvec3 origin = r.previous.view.origin;
    const glm::dvec2 seen = test::pixel_that_sees_reflected(
        r.previous.view, glm::dvec3(mirror * glm::dvec4(r.now.view.origin + point, 1)) - origin,
        glm::normalize(glm::dmat3(mirror) * glm::dvec3(r.now.normal_at(x, y))),
        glm::dvec3(thing * glm::dvec4(hit, 1)) - origin);
    EXPECT_NEAR(r.vector(x, y).x, seen.x - (x + 0.5), 5e-3) << x << ", " << y;
    EXPECT_NEAR(r.vector(x, y).y, seen.y - (y + 0.5), 5e-3) << x << ", " << y;
    EXPECT_GT(glm::length(r.vector(x, y)), 0.5) << "a vector that says something";
    ++compared;
  });
  EXPECT_GT(found, 1000);
  EXPECT_GT(compared, 20);
}

TEST(GlossyHistory, RelativeVectorOfAMirrorIsItsSpecularOne) {
  Reflections r;
  r.move_everything();
  r.render();
  r.run(GlossyRule::kSpecular);
  const EffectHistory specular = std::exchange(r.out, EffectHistory(kWidth, kHeight));
  r.run(GlossyRule::kRelative);
  int compared = 0;
  r.for_each_found([&](int x, int y) {
    if (!specular.taps[0].at(x, y).any()) return;
    EXPECT_NEAR(r.out.motion[0].at(x, y), specular.motion[0].at(x, y), 2e-3f);
    EXPECT_NEAR(r.out.motion[1].at(x, y), specular.motion[1].at(x, y), 2e-3f);
    ++compared;
  });
  EXPECT_GT(compared, 1000);
}

TEST(GlossyHistory, WhereAllStandsStillThereIsNoRelativeVectorBesideTheSurfaces) {
  for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f}) {
    Reflections r;
    r.render(roughness);
    test::Random random(61);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!r.sampled(x, y)) continue;
        // Any normal, any direction of the lobe, any distance.
        const glm::vec3 n =
            glm::normalize(r.now.normal_at(x, y) + 0.3f * glm::vec3(random.in_box(1)));
        for (Guides* guides : {&r.previous, &r.now})
          test::set_pixel(*guides, x, y, guides->depth().at(x, y), n, kMirror);
        const glm::vec3 any = glm::normalize(n + 0.9f * glm::vec3(random.in_box(1)));
        for (int c = 0; c < 3; ++c) r.direction.channel(c).at(x, y) = any[c];
        const float distances[] = {0.0f, 1e-3f, 0.7f, 30.0f, 1e6f, test::kInf};
        r.distance.channel(0).at(x, y) = distances[random.bits() % 6];
      }
    r.run(GlossyRule::kSpecular);
    EXPECT_GT(r.for_each_found([](int, int) {}), 500);
    r.run(GlossyRule::kRelative);
    EXPECT_EQ(r.for_each_found([](int, int) {}), 0);
    for (int k = 0; k < 3; ++k)
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          ASSERT_EQ(r.out.motion[k].at(x, y), 0.0f) << x << ", " << y;
  }
}

TEST(GlossyHistory, StochasticVectorOfAMirrorOrAtContactIsExactlyTheSpecularOne) {
  for (const bool contact : {false, true}) {
    Reflections r;
    r.move_everything();
    r.render(contact ? 0.8f : 0.0f);
    if (contact) test::fill(r.distance.channel(0), 0.0f);
    r.run(GlossyRule::kSpecular);
    const EffectHistory specular = std::exchange(r.out, EffectHistory(kWidth, kHeight));
    r.run(GlossyRule::kStochastic, {7, 8});
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(r.found(x, y), specular.taps[0].at(x, y).any());
        for (int c = 0; c < 2; ++c)
          ASSERT_EQ(r.out.motion[c].at(x, y), specular.motion[c].at(x, y)) << x << ", " << y;
      }
  }
}

TEST(GlossyHistory, OfTheSkyIsFiniteAndDoesNotFollowATranslation) {
  Reflections r(false);
  r.camera = test::perspective_camera(kWidth, kHeight, {0.3, 0.1, -0.2});
  r.render(0.3f);
  r.run(GlossyRule::kSpecular);
  int mirrored = r.for_each_found([&](int x, int y) {
    ASSERT_EQ(r.distance.channel(0).at(x, y), test::kInf);
    EXPECT_NEAR(r.vector(x, y).x, 0, 2e-3) << "what is infinitely far keeps its pixel";
    EXPECT_NEAR(r.vector(x, y).y, 0, 2e-3);
  });
  EXPECT_GT(mirrored, 1000);
  r.run(GlossyRule::kStochastic, {1, 2});
  mirrored = r.for_each_found([&](int x, int y) {
    const glm::dvec2 v = r.vector(x, y);
    ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y));
    ASSERT_LT(glm::length(v), 6 * double{kWidestGlossySpreadPx});
  });
  EXPECT_GT(mirrored, 1000);
}

TEST(GlossyHistory, OfASeedAndFrameIsAlwaysTheSameAndOfOthersIsNot) {
  Reflections r;
  r.render(0.3f);
  const auto vectors = [&](FrameKey key) {
    r.run(GlossyRule::kStochastic, key);
    std::vector<float> out;
    for (int y = 0; y < kHeight; ++y)
      for (int c = 0; c < 2; ++c)
        out.insert(out.end(), r.out.motion[c].row(y), r.out.motion[c].row(y) + kWidth);
    return out;
  };
  const auto first = vectors({5, 9});
  EXPECT_EQ(first, vectors({5, 9}));
  const auto differing = [&](FrameKey key) {
    const auto other = vectors(key);
    int count = 0;
    for (std::size_t k = 0; k < first.size(); ++k) count += first[k] != other[k] ? 1 : 0;
    return count;
  };
  const int all = 2 * r.for_each_found([](int, int) {});
  EXPECT_GT(differing({5, 10}), 0.9 * all);
  EXPECT_GT(differing({6, 9}), 0.9 * all);
  EXPECT_GT(differing({5, -9}), 0.9 * all);
}

// Standard normal numbers, in units of the spread, along and across the axis of incidence; of n
// pixels the mean is off by 1/sqrt(n), the variance by sqrt(2/n): five of these.
TEST(GlossyHistory, OffsetsHaveNoMeanAndTheVarianceOfTheSpread) {
  Reflections r;
  r.render(0.17f);
  r.run(GlossyRule::kSpecular);
  const EffectHistory specular = std::exchange(r.out, EffectHistory(kWidth, kHeight));
  glm::dvec2 sum(0), squares(0);
  double product = 0, n = 0;
  for (const std::int64_t frame : {1, 2, 3}) {
    r.run(GlossyRule::kStochastic, {3, frame});
    r.for_each_found([&](int x, int y) {
      const glm::vec3 s = r.now.position_at(x, y), normal = r.now.normal_at(x, y);
      const float view_m = glm::length(s);
      const auto spread = glossy_spread(
          1.0f / static_cast<float>(r.now.view.pixel_angle), ggx_alpha_from_roughness(0.17f),
          view_m, r.distance.channel(0).at(x, y), std::abs(glm::dot(s, normal)) / view_m);
      // A sample off screen would be replaced by the centre.
      const double reach = 6 * double(spread.in_plane);
      if (x < reach || y < reach || x > kWidth - reach || y > kHeight - reach) return;
      if (!r.sampled(x, std::max(static_cast<int>(y - reach), 0))) return;
      const glm::dvec2 offset =
          r.vector(x, y) - glm::dvec2(specular.motion[0].at(x, y), specular.motion[1].at(x, y));
      const glm::dvec2 axis(incidence_axis(glm::mat4(r.now.view.pixel_from_relative), s, normal));
      const glm::dvec2 unit(
          glm::dot(offset, axis) / double(spread.in_plane),
          glm::dot(offset, glm::dvec2(-axis.y, axis.x)) / double(spread.out_of_plane));
      sum += unit;
      squares += unit * unit;
      product += unit.x * unit.y;
      n += 1;
    });
  }
  ASSERT_GT(n, 1000);
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(sum[axis] / n, 0, 5 / std::sqrt(n));
    EXPECT_NEAR(squares[axis] / n, 1, 5 * std::sqrt(2 / n));
  }
  EXPECT_NEAR(product / n, 0, 5 / std::sqrt(n));
}

TEST(GlossyHistory, NeedsASampleAndTheSameReceiver) {
  struct Case {
    const char* why;
    void (*spoil)(Reflections&);
  };
  const Case cases[] = {
      {"no direction",
       [](Reflections& r) {
         for (int c = 0; c < 3; ++c) test::fill(r.direction.channel(c), 0.0f);
       }},
      {"direction not finite",
       [](Reflections& r) { test::fill(r.direction.channel(1), test::kInf); }},
      {"direction NaN", [](Reflections& r) { test::fill(r.direction.channel(1), test::kNaN); }},
      {"distance NaN", [](Reflections& r) { test::fill(r.distance.channel(0), test::kNaN); }},
      {"negative distance", [](Reflections& r) { test::fill(r.distance.channel(0), -1.0f); }},
      {"no surface", [](Reflections& r) { test::fill(r.now.depth_normal[0], 0.0f); }},
      {"another receiver",
       [](Reflections& r) {
         for (int y = 0; y < kHeight; ++y)
           std::fill_n(r.previous.id[0].row(y), kWidth, std::uint32_t{9});
       }},
      {"another roughness",
       [](Reflections& r) { test::fill(r.previous.roughness[0], 0.3f + 0.11f); }},
      {"off screen", [](Reflections& r) {
         r.motion = SceneMotion();
         r.camera_before = test::perspective_camera(kWidth, kHeight, {0, 0, 0}, {1, 0, 0});
         r.render(0.3f);
       }}};
  for (const GlossyRule rule :
       {GlossyRule::kSpecular, GlossyRule::kStochastic, GlossyRule::kRelative})
    for (const Case& c : cases) {
      Reflections r;
      r.scene.objects[kThing] = glm::translate(glm::dmat4(1), {0.01, 0.0, 0.0});
      r.render(0.3f);
      r.run(rule);
      ASSERT_GT(r.for_each_found([](int, int) {}), 1000);
      c.spoil(r);
      r.run(rule);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          ASSERT_FALSE(r.found(x, y)) << c.why << " rule " << static_cast<int>(rule);
          for (int k = 0; k < 3; ++k) ASSERT_EQ(r.out.motion[k].at(x, y), 0.0f) << c.why;
        }
    }
}

TEST(GlossyHistory, ComparesRoughnessOnlyWhereBothFramesHaveIt) {
  Reflections r;
  r.render(0.3f);
  test::fill(r.previous.roughness[0], 0.39f);
  r.run(GlossyRule::kSpecular);
  const int found = r.for_each_found([](int, int) {});
  EXPECT_GT(found, 1000) << "within the tolerance";
  r.previous.roughness = {};
  r.run(GlossyRule::kSpecular);
  EXPECT_EQ(r.for_each_found([](int, int) {}), found);
}

TEST(GlossyHistory, WithoutHitIdsTakesWhatIsHitForStatic) {
  Reflections r;
  r.scene.objects[kThing] = glm::translate(glm::dmat4(1), {0.3, 0.0, 0.0});
  r.render();
  trace_glossy_history(r.frames(), {&r.direction, &r.distance, nullptr}, GlossyRule::kRelative, {},
                       r.out);
  EXPECT_EQ(r.for_each_found([](int, int) {}), 0);
  r.run(GlossyRule::kRelative);
  double longest = 0;
  r.for_each_found([&](int x, int y) { longest = std::max(longest, glm::length(r.vector(x, y))); });
  EXPECT_GT(longest, 1.0);
}

}  // namespace
}  // namespace holdfast
