// Frames that come faster than they are filtered, under the policy that keeps the latest.
#include <cmath>

#include "server/session.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using test::RawClient;
using test::RawStream;

TEST(LateFrames, LeaveTheirCutAndTransformsToTheNextFrame) {
  const DenoiserConfig config = test::small_config();
  server::SessionConfig dropping;
  dropping.denoiser = config;
  server::Session session("id", "token", dropping, 3);
  Denoiser direct(config);
  PlaneSet expected;
  Frame first = test::small_frame(config, 0);
  direct.filter(first, expected);
  session.filter(first, 0);

  Frame late = test::small_frame(config, 1), next = test::small_frame(config, 2);
  late.cut = true;
  late.objects[1] = glm::translate(glm::dmat4(1.0), {0.1, 0.0, 0.0});
  Frame told = test::small_frame(config, 2);
  told.cut = true;
  told.objects = late.objects;
  direct.filter(told, expected);
  const auto dropped = session.drop(late, 0);
  ASSERT_TRUE(dropped);
  EXPECT_TRUE(dropped->dropped);
  const auto answer = session.filter(next, 0);
  EXPECT_TRUE(answer->report.history_reset);
  EXPECT_TRUE(test::same_bits(answer->results, expected));
  EXPECT_EQ(session.repeat(1, 0), dropped) << "it stays dropped if it comes again";
  EXPECT_FALSE(session.drop(late, 0)) << "it is not newer than the last";
}

TEST(LateFrames, SpoilNothingWhenATransformOfOneIsBad) {
  const DenoiserConfig config = test::small_config();
  server::SessionConfig dropping;
  dropping.denoiser = config;
  server::Session session("id", "token", dropping, 3);
  Frame late = test::small_frame(config, 0), second = test::small_frame(config, 1),
        third = test::small_frame(config, 2);
  late.objects[1] = glm::dmat4(std::nan(""));
  session.drop(late, 0);
  EXPECT_THROW(session.filter(second, 0), InputError);
  EXPECT_NO_THROW(session.filter(third, 0));
}

TEST(LateFrames, AreDroppedWhileTheServerIsBusyAndTheLatestIsFiltered) {
  const server::Server server(test::server_config(1));
  const DenoiserConfig large = test::small_config(2000, 1500), small = test::small_config();
  RawClient busy(server.address());
  ASSERT_TRUE(busy.create(large).ok());
  const Frame second = test::small_frame(large, 1);
  RawStream stream(busy);
  stream.attach();
  stream.write(test::small_frame(large, 0), large);

  client::SessionOptions options = test::session_options(server, small);
  options.late_frames = client::LateFrames::kLatest;
  client::Session session(options);
  std::vector<std::shared_ptr<const Frame>> frames;
  for (int i = 0; i < 3; ++i)
    frames.push_back(std::make_shared<const Frame>(test::small_frame(small, i)));
  stream.write(second, large);
  stream.read_result();  // of the first: the second is next, and takes far longer than three small
                         // ones to arrive
  for (const auto& frame : frames) session.submit(frame);
  std::vector<bool> dropped;
  for (int i = 0; i < 3; ++i) {
    const auto output = session.receive();
    ASSERT_TRUE(output && !output->error);
    EXPECT_EQ(output->index, i);
    EXPECT_EQ(output->planes.size() == 0, output->dropped);
    dropped.push_back(output->dropped);
  }
  EXPECT_EQ(dropped, (std::vector<bool>{true, true, false}));
}

}  // namespace
}  // namespace holdfast
