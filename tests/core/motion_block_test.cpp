#include "core/history/motion_block.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/kernels/isa.h"
#include "tests/core/small_world.h"

namespace holdfast {
namespace {

struct Block {
  std::vector<float> x, y, known, motion_x, motion_y;
  std::int32_t any_stays = -1;

  explicit Block(std::size_t count)
      : x(count), y(count), known(count), motion_x(count), motion_y(count) {}
  void write(float first_x, float row) {
    write_motion({x.data(), y.data(), known.data(), static_cast<int>(x.size()), first_x, row,
                  motion_x.data(), motion_y.data(), &any_stays});
  }
};

class MotionOfBlock : public testing::Test {
 protected:
  ~MotionOfBlock() override { select_isa(before_); }

 private:
  Isa before_ = selected_isa();
};

TEST_F(MotionOfBlock, IsTheWayFromThePixelAndZeroWhereItIsNotKnown) {
  test::Random random(31);
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (const int count : {1, 7, 16, 33, 64}) {
      Block block(static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        block.x[at] = 100.0f * random.real();
        block.y[at] = 100.0f * random.real();
        block.known[at] = i % 3 == 1 ? 0.0f : 1.0f;
      }
      block.write(20.5f, 7.5f);
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double x = i % 3 == 1 ? 0.0 : double{block.x[at]} - (20.5 + i);
        const double y = i % 3 == 1 ? 0.0 : double{block.y[at]} - 7.5;
        EXPECT_NEAR(block.motion_x[at], x, 1e-5) << isa_name(isa) << ' ' << count << ' ' << i;
        EXPECT_NEAR(block.motion_y[at], y, 1e-5) << isa_name(isa) << ' ' << count << ' ' << i;
      }
      EXPECT_EQ(block.any_stays, 0);
    }
  }
}

TEST_F(MotionOfBlock, StaysIfOneThatIsKnownKeepsBothItsCoordinates) {
  for (const Isa isa : available_isas()) {
    select_isa(isa);
    for (int stays = 0; stays < 37; ++stays) {
      Block block(37);
      const auto at = static_cast<std::size_t>(stays);
      const auto written = [&](float x, float y, float known) {
        std::fill(block.known.begin(), block.known.end(), 1.0f);
        block.x[at] = x;
        block.y[at] = y;
        block.known[at] = known;
        block.write(0.5f, 3.5f);
        return block.any_stays;
      };
      const float own_x = static_cast<float>(stays) + 0.5f;
      EXPECT_EQ(written(own_x, 3.5f, 1.0f), 1) << isa_name(isa) << ' ' << stays;
      EXPECT_EQ(written(own_x, 3.5f, 0.0f), 0) << "not known";
      EXPECT_EQ(written(own_x, 4.5f, 1.0f), 0) << "another row";
      EXPECT_EQ(written(own_x + 1.0f, 3.5f, 1.0f), 0) << "another column";
    }
  }
}

}  // namespace
}  // namespace holdfast
