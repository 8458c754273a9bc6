#include "core/history/tap_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/history/tap_lanes.h"
#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

using test::Random;

/// A wall of two objects with holes, dents and pixels that face elsewhere.
Guides rough_wall(int width, int height, Random& random) {
  Guides guides = test::wall(test::perspective_camera(width, height), width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float kind = random.real();
      if (kind < 0.1f) test::set_pixel(guides, x, y, 0.0f, glm::vec3(0), 1);
      if (kind > 0.1f && kind < 0.2f) guides.depth_normal[0].at(x, y) = random.real(4.0f, 6.0f);
      if (kind > 0.8f) guides.id[0].at(x, y) = 2;
      if (kind > 0.75f && kind < 0.85f)
        test::set_pixel(guides, x, y, 5.0f, glm::normalize(glm::vec3(0.6f, 0, 1)), 1);
    }
  return guides;
}

/// Receivers of the wall, looked for here and there, some of them outside or nowhere.
struct Row {
  FollowedBlock followed{};
  std::uint32_t id[kFollowBlock];

  Row(const Guides& guides, Random& random, bool steady) {
    const auto width = static_cast<float>(guides.view.width);
    const auto height = static_cast<float>(guides.view.height);
    for (int i = 0; i < kFollowBlock; ++i) {
      const float step = static_cast<float>(i);
      followed.x[i] = steady ? 0.3f + 1.02f * step : random.real(-3, width + 3);
      followed.y[i] = steady ? 1.7f + 0.03f * step : random.real(-3, height + 3);
      followed.found[i] = random.real() < 0.9f ? 1.0f : 0.0f;
      const glm::vec3 point = guides.rays.position(followed.x[i], followed.y[i], 5.0f);
      for (int axis = 0; axis < 3; ++axis) followed.point[axis][i] = point[axis];
      followed.normal[2][i] = 1.0f;
      id[i] = random.real() < 0.8f ? 1 : 2;
    }
    followed.x[3] = test::kNaN;
    followed.y[5] = test::kInf;
  }
};

void expect_same(const Taps& got, const Taps& want, Isa isa, int i) {
  for (int k = 0; k < 4; ++k)
    ASSERT_EQ(got.weight[k], want.weight[k]) << isa_name(isa) << ", lane " << i;
  if (want.any()) {
    ASSERT_EQ(got.offset, want.offset) << isa_name(isa) << ", lane " << i;
  }
}

TEST(TapSearch, FindsWhatIsFoundForOnePixelOnEveryInstructionSet) {
  const test::IsaGuard guard;
  Random random(61);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {9, 1}, {2, 2}, {70, 11}, {90, 40}})
    for (const bool steady : {true, false}) {
      const Guides guides = rough_wall(width, height, random);
      const Row row(guides, random, steady);
      for (const Isa isa : available_isas()) {
        select_isa(isa);
        for (const int count : {1, 15, 16, 33, kFollowBlock}) {
          Taps near[kFollowBlock], any[kFollowBlock];
          find_block_taps({guides, row.followed, row.id, count, near});
          find_block_taps_on_any_surface({guides, row.followed, row.id, count, any});
          for (int i = 0; i < count; ++i) {
            const bool found = row.followed.found[i] > 0.0f;
            const float x = row.followed.x[i], y = row.followed.y[i];
            const Receiver receiver = receiver_of(row.followed, i, row.id[i]);
            expect_same(near[i], found ? find_taps(guides, x, y, receiver) : Taps{}, isa, i);
            expect_same(any[i], found ? find_taps_on_any_surface(guides, x, y) : Taps{}, isa, i);
          }
        }
      }
    }
}

TEST(TapSearch, LeavesOutWhatIsOfAnotherRoughnessOnEveryInstructionSet) {
  const test::IsaGuard guard;
  Random random(63);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {70, 11}}) {
    Guides guides = rough_wall(width, height, random);
    guides.roughness = Channels<float>(width, height, 1);
    test::fill_random(guides.roughness[0], random, 0, 0.5f);
    const Row row(guides, random, true);
    float roughness[kFollowBlock];
    for (float& wanted : roughness) wanted = random.real(0, 0.5f);
    int kept = 0, left_out = 0;
    for (const Isa isa : available_isas()) {
      select_isa(isa);
      Taps got[kFollowBlock];
      float any[kFollowBlock];
      find_block_taps({guides, row.followed, row.id, kFollowBlock, got, roughness, any});
      for (int i = 0; i < kFollowBlock; ++i) {
        Taps want;
        if (row.followed.found[i] > 0.0f)
          want = find_taps(guides, row.followed.x[i], row.followed.y[i],
                           receiver_of(row.followed, i, row.id[i]));
        if (want.any()) {
          const float there = gather(std::as_const(guides.roughness)[0], want);
          const bool same = std::abs(there - roughness[i]) <= kTapRoughnessTolerance;
          ++(same ? kept : left_out);
          if (!same) want = Taps{};
        }
        expect_same(got[i], want, isa, i);
        ASSERT_EQ(any[i], want.any() ? 1.0f : 0.0f) << isa_name(isa) << ", lane " << i;
      }
    }
    if (width > 1) {
      EXPECT_GT(kept, 0);
      EXPECT_GT(left_out, 0);
    }
  }
}

/// Taps of a row whose offsets follow one another in `runs` pieces, with gaps.
std::vector<Taps> pieces(const Guides& guides, int count, int runs, Random& random) {
  std::vector<Taps> taps(static_cast<std::size_t>(count));
  const int width = guides.view.width;
  for (int i = 0; i < count; ++i) {
    if (random.real() < 0.1f) continue;
    const int run = i * runs / count;
    Taps& t = taps[static_cast<std::size_t>(i)];
    const int x = i + (run % 2 == 0 ? 3 : -run);
    t = identity_taps(guides, std::clamp(x, 0, width - 2), (run + 1) % 2);
    for (float& weight : t.weight) weight = random.real(0.1f, 1);
  }
  return taps;
}

TEST(TapLanes, GatherWhatIsGatheredForOnePixel) {
  Random random(67);
  for (const int height : {2, 3, 40})
    for (const int runs : {1, 2, 3, 7, 31}) {
      const Guides guides = test::empty_guides(test::perspective_camera(80, height), 80, height);
      Channels<float> image(80, height, 1);
      test::fill_random(image[0], random, -1, 1);
      test::poison_padding(image[0]);
      const std::vector<Taps> taps = pieces(guides, kTapBlock - 7, runs, random);
      TapLanes lanes;
      const ChannelView<const float> channel = image[0];
      load_lanes(taps.data(), kTapBlock - 7, channel, lanes);
      float got[kTapBlock], fetched[kTapBlock];
      gather_lanes(channel, lanes, got);
      fetch(lanes, channel.data, fetched);
      for (int i = 0; i < lanes.count; ++i) {
        const Taps& t = taps[static_cast<std::size_t>(i)];
        ASSERT_NEAR(got[i], gather(channel, t), 1e-6f) << runs << " runs, lane " << i;
        if (t.any()) {
          ASSERT_EQ(fetched[i], channel.data[t.offset]);
        }
      }
    }
}

}  // namespace
}  // namespace holdfast
