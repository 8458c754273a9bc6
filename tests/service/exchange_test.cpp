#include "client/sdk/exchange.h"

#include <gtest/gtest.h>

#include "tests/service/test_frames.h"

namespace holdfast::client {
namespace {

/// An exchange without a network: the test plays the server.
class Frames : public ::testing::Test {
 protected:
  Exchange make(int rewarm_frames) {
    return Exchange({config.planes, config.width, config.height, rewarm_frames});
  }
  std::shared_ptr<const Frame> frame(std::int64_t index) const {
    return std::make_shared<const Frame>(test::small_frame(config, index));
  }
  static FrameOutput answer(std::int64_t index) {
    FrameOutput output;
    output.index = index;
    return output;
  }
  /// What the stream may send now.
  static std::vector<std::int64_t> sent(Exchange& exchange) {
    std::vector<std::int64_t> indices;
    while (const auto out = exchange.next()) indices.push_back(out->frame->index);
    return indices;
  }
  using Indices = std::vector<std::int64_t>;
  const DenoiserConfig config = test::small_config(4, 3);
};

TEST_F(Frames, AreSentAgainInOrderByTheNextStreamUntilTheyAreAnswered) {
  Exchange exchange = make(2);
  exchange.opened(3, true);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(exchange.submit(frame(i), false));
  EXPECT_FALSE(exchange.submit(frame(3), false)) << "three are in flight";
  EXPECT_EQ(sent(exchange), (Indices{0, 1, 2}));
  exchange.answered(answer(0));
  exchange.opened(3, false);
  EXPECT_EQ(sent(exchange), (Indices{1, 2}));
  exchange.answered(answer(1));
  exchange.answered(answer(2));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(exchange.receive(false)->index, i);
  EXPECT_FALSE(exchange.receive(false));
}

TEST_F(Frames, WarmAFreshSessionBeforeWhatWasNotAnsweredAndTheirAnswersAreNotGivenOut) {
  Exchange exchange = make(2);
  exchange.opened(3, true);
  for (int i = 0; i < 4; ++i) {
    exchange.submit(frame(i), false);
    sent(exchange);
    exchange.answered(answer(i));
    exchange.receive(false);
  }
  exchange.submit(frame(4), false);
  exchange.opened(2, true);
  EXPECT_EQ(sent(exchange), (Indices{2, 3})) << "no more than there are credits";
  exchange.answered(answer(2));
  EXPECT_EQ(sent(exchange), (Indices{4}));
  exchange.answered(answer(3));
  EXPECT_FALSE(exchange.receive(false));
  exchange.answered(answer(4));
  const auto output = exchange.receive(false);
  ASSERT_TRUE(output);
  EXPECT_EQ(output->index, 4);
  EXPECT_TRUE(output->history_lost);
}

TEST_F(Frames, BringWhereThingsStandToAFreshSession) {
  Exchange exchange = make(1);
  exchange.opened(3, true);
  for (int i = 0; i < 3; ++i) {
    Frame moved = test::small_frame(config, i);
    if (i == 0) moved.objects[7] = glm::translate(glm::dmat4(1.0), {1.0, 2.0, 3.0});
    if (i > 0) moved.lights.clear();
    exchange.submit(std::make_shared<const Frame>(std::move(moved)), false);
    sent(exchange);
    exchange.answered(answer(i));
  }
  exchange.opened(3, true);
  const auto first = exchange.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->frame->index, 2);
  EXPECT_EQ(first->objects.count(7), 1u) << "moved in frame 0, which is sent no more";
  EXPECT_EQ(first->lights.count(0), 1u);
}

TEST_F(Frames, OfAnotherEpochOrBeforeACutWarmNothing) {
  Exchange exchange = make(4);
  exchange.opened(3, true);
  const auto pass = [&](int index, bool cut) {
    Frame made = test::small_frame(config, index);
    made.cut = cut;
    exchange.submit(std::make_shared<const Frame>(std::move(made)), false);
    sent(exchange);
    exchange.answered(answer(index));
  };
  for (int i = 0; i < 3; ++i) pass(i, false);
  pass(3, true);
  exchange.opened(3, true);
  EXPECT_EQ(sent(exchange), (Indices{3}));
  exchange.answered(answer(3));
  exchange.restart();
  pass(0, false);
  exchange.opened(3, true);
  EXPECT_EQ(sent(exchange), (Indices{0}));
}

TEST_F(Frames, AnsweredOutOfTurnBreakTheProtocol) {
  Exchange exchange = make(0);
  exchange.opened(3, true);
  exchange.submit(frame(0), false);
  EXPECT_THROW(exchange.answered(answer(0)), std::runtime_error) << "not sent yet";
  sent(exchange);
  EXPECT_THROW(exchange.answered(answer(1)), std::runtime_error);
  EXPECT_NO_THROW(exchange.answered(answer(0)));
}

TEST_F(Frames, ThatWaitForACreditAreRefusedWhenTheSessionEnds) {
  Exchange exchange = make(0);
  exchange.opened(1, true);
  exchange.submit(frame(0), false);
  exchange.close(std::make_exception_ptr(ConnectionError("lost")));
  EXPECT_THROW(exchange.submit(frame(1), true), ConnectionError);
  EXPECT_THROW(exchange.receive(true), ConnectionError);
}

}  // namespace
}  // namespace holdfast::client
