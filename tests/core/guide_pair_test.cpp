#include "core/history/guide_pair.h"

#include <cstring>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/frame/lent_images.h"
#include "core/history/guide_block.h"
#include "core/history/taps.h"
#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

glm::vec3 random_normal(test::Random& random) {
  glm::vec3 n;
  do {
    n = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
  } while (glm::length(n) < 0.1f || glm::length(n) > 1.0f);
  return glm::normalize(n);
}

/// Rows of normals and roughness, there and back.
struct Rows {
  explicit Rows(int n)
      : count(n), depth(size(), 1.0f), roughness(size()), packed(size()), packed_roughness(size()) {
    for (auto* axes : {&in, &out})
      for (auto& axis : *axes) axis.resize(size());
    back.resize(size());
  }
  std::size_t size() const { return static_cast<std::size_t>(count); }
  void set(int i, const glm::vec3& n) {
    for (int axis = 0; axis < 3; ++axis) in[axis][static_cast<std::size_t>(i)] = n[axis];
  }
  glm::vec3 got(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {out[0][k], out[1][k], out[2][k]};
  }
  void pass() {
    pack_guides({{in[0].data(), in[1].data(), in[2].data()},
                 roughness.data(),
                 count,
                 packed.data(),
                 packed_roughness.data()});
    unpack_guides({depth.data(),
                   packed.data(),
                   packed_roughness.data(),
                   count,
                   {out[0].data(), out[1].data(), out[2].data()},
                   back.data()});
  }

  int count;
  std::vector<float> depth, roughness, back;
  std::vector<float> in[3], out[3];
  std::vector<std::uint32_t> packed;
  std::vector<std::uint8_t> packed_roughness;
};

TEST(GuideBlock, NormalsComeBackWithinTheErrorThatIsStated) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    test::Random random(3);
    Rows rows(20011);
    std::vector<glm::vec3> normals;
    for (int i = 0; i < rows.count; ++i) {
      normals.push_back(random_normal(random));
      // Along the edges and diagonals of the octahedron, too.
      if (i % 5 == 1) normals.back()[i % 3] = 0;
      if (i % 5 == 2) normals.back() = {normals.back().x, normals.back().x, normals.back().y};
      normals.back() = glm::normalize(normals.back());
      rows.set(i, normals.back());
    }
    rows.pass();
    for (int i = 0; i < rows.count; ++i) {
      const glm::vec3 n = normals[static_cast<std::size_t>(i)], got = rows.got(i);
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(got[axis], n[axis], kPackedNormalError) << isa_name(isa) << ' ' << i;
      ASSERT_NEAR(glm::length(got), 1.0f, 2e-7f);
    }
  }
}

TEST(GuideBlock, NormalsAlongAnAxisStayExactAndThoseOfNoSurfaceZero) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (const int count : {1, 7, 64, 65}) {
      Rows rows(count);
      for (int i = 0; i < count; ++i) {
        glm::vec3 n(0);
        n[i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        if (i % 7 == 3) n = glm::vec3(0), rows.depth[static_cast<std::size_t>(i)] = 0;
        rows.set(i, n);
      }
      rows.pass();
      for (int i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ(rows.got(i)[axis], rows.in[axis][static_cast<std::size_t>(i)])
              << isa_name(isa) << ' ' << i;
    }
  }
}

TEST(GuideBlock, OnlyAMirrorIsKeptAsOneAndOnlyTheRoughestAsThat) {
  const test::IsaGuard guard;
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    const std::vector<float> values = {0.0f, 1e-30f, 1e-4f, 0.001f, 0.1f,     0.25f,
                                       0.5f, 0.7f,   0.9f,  0.999f, 0.99999f, 1.0f};
    Rows rows(static_cast<int>(values.size()));
    rows.roughness = values;
    rows.pass();
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(rows.back[i], values[i], 1.0f / 255.0f) << isa_name(isa);
      EXPECT_EQ(rows.back[i] == 0.0f, values[i] == 0.0f) << values[i];
      EXPECT_EQ(rows.back[i] == 1.0f, values[i] == 1.0f) << values[i];
    }
  }
}

constexpr int kWidth = 37, kHeight = 5;

/// Fills guides with what follows from `seed`; a tenth is no surface.
void fill(Guides& guides, std::uint32_t seed) {
  test::Random random(seed);
  guides.view.width = kWidth;
  guides.view.height = kHeight;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool surface = random.real() > 0.1f;
      const glm::vec3 n = surface ? random_normal(random) : glm::vec3(0);
      guides.depth_normal[0].at(x, y) = surface ? random.real(0.01f, 1e6f) : 0.0f;
      for (int axis = 0; axis < 3; ++axis) guides.depth_normal[1 + axis].at(x, y) = n[axis];
      guides.id[0].at(x, y) = surface ? 0xffffffffu - static_cast<std::uint32_t>(x) : 0;
      if (guides.roughness) guides.roughness[0].at(x, y) = random.real();
      if (guides.motion) guides.motion[1].at(x, y) = random.real(-30, 30);
    }
}

/// Memory for the images of `pair` that have none, which holds anything.
struct Lent {
  explicit Lent(GuidePair& of) : pair(of) {
    ImageBytes bytes;
    GuidePair::each_image(pair, bytes);
    memory.assign(bytes.lent / sizeof(Line) + 1, Line{});
    std::memset(memory.data(), 0xff, bytes.lent);
    GuidePair::each_image(pair, LendImages{reinterpret_cast<std::byte*>(memory.data())});
  }
  ~Lent() { GuidePair::each_image(pair, TakeBackImages{}); }
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  GuidePair& pair;
  std::vector<Line> memory;
};

TEST(GuidePair, FindsTheGuidesOfTheFrameBeforeAgain) {
  for (const HistoryFormat format : {HistoryFormat::kFloat, HistoryFormat::kPacked})
    for (const bool more : {false, true}) {
      GuidePair pair(kWidth, kHeight, more, more, format);
      for (std::uint32_t frame = 0; frame < 3; ++frame) {
        const Lent lent(pair);
        fill(pair.advance(frame > 0), frame);
        if (frame > 0) {
          Guides before(kWidth, kHeight);
          if (more) before.roughness = Channels<float>(kWidth, kHeight, 1);
          if (more) before.motion = Channels<float>(kWidth, kHeight, 2);
          fill(before, frame - 1);
          const float error = format == HistoryFormat::kPacked ? kPackedNormalError : 0.0f;
          const Guides& found = pair.previous();
          for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
              ASSERT_EQ(found.depth().at(x, y), before.depth().at(x, y));
              ASSERT_EQ(found.id[0].at(x, y), before.id[0].at(x, y));
              for (int axis = 0; axis < 3; ++axis)
                ASSERT_NEAR(found.normal(axis).at(x, y), before.normal(axis).at(x, y), error);
              if (!more) continue;
              ASSERT_EQ(found.motion[1].at(x, y), before.motion[1].at(x, y));
              ASSERT_NEAR(found.roughness_at(x, y), before.roughness_at(x, y),
                          error > 0 ? 1.0f / 255.0f : 0.0f);
            }
        }
        pair.keep();
      }
      // What twice the rows take more, so that what images have before them is out.
      const GuidePair taller(kWidth, 2 * kHeight, more, more, format);
      const double kept = static_cast<double>(taller.kept_bytes() - pair.kept_bytes()) /
                          static_cast<double>(kHeight * padded_stride(kWidth));
      const double packed = 12 + (more ? 9 : 0), floats = 20 + (more ? 12 : 0);
      EXPECT_DOUBLE_EQ(kept, format == HistoryFormat::kPacked ? packed : floats);
    }
}

// At rest every surface keeps its place, whatever rounding does to its normal.
TEST(GuidePair, ASurfaceIsTheSameAfterItsNormalWasRounded) {
  GuidePair pair(kWidth, kHeight, false, false, HistoryFormat::kPacked);
  for (int frame = 0; frame < 2; ++frame) {
    const Lent lent(pair);
    fill(pair.advance(frame > 0), 7);
    if (frame > 0) {
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          EXPECT_TRUE(same_surface(pair.now(), pair.previous(), x, y));
      Guides& now = pair.now();
      now.depth_normal[1].at(3, 3) += 2e-4f;
      EXPECT_FALSE(same_surface(now, pair.previous(), 3, 3)) << "another normal";
      std::uint8_t same[kWidth];
      same_surface_block(now, pair.previous(), 0, 3, kWidth, same);
      for (int x = 0; x < kWidth; ++x) EXPECT_EQ(same[x], x == 3 ? 0 : 1);
    }
    pair.keep();
  }
}

TEST(GuidePair, HandsItsGuidesOnBetweenFrames) {
  for (const HistoryFormat format : {HistoryFormat::kFloat, HistoryFormat::kPacked}) {
    GuidePair pair(kWidth, kHeight, false, false, format);
    Guides given(kWidth, kHeight);
    fill(given, 1);
    pair.set_last(std::move(given));
    const Guides last = pair.last();
    Guides expected(kWidth, kHeight);
    fill(expected, 1);
    EXPECT_EQ(last.view.width, kWidth);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        EXPECT_EQ(last.depth().at(x, y), expected.depth().at(x, y));
        EXPECT_EQ(last.id[0].at(x, y), expected.id[0].at(x, y));
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(last.normal(axis).at(x, y), expected.normal(axis).at(x, y),
                      last.normal_error);
      }
  }
}

}  // namespace
}  // namespace holdfast
