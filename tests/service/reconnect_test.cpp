#include <atomic>
#include <thread>

#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using client::FrameOutput;
using client::Session;
using client::SessionOptions;

/// A client session on a server of this process, which is stopped and started again.
class Reconnecting : public ::testing::Test {
 protected:
  void start(const std::string& listen = "127.0.0.1:0") {
    server::ServerConfig at = test::server_config(1);
    at.listen = listen;
    server = std::make_unique<server::Server>(at);
  }
  void restart() {
    const std::string address = server->address();
    server.reset();
    start(address);
  }
  FrameOutput pass(Session& session, int index) const {
    session.submit(test::small_frame(config, index));
    auto output = session.receive();
    EXPECT_FALSE(output->error) << output->error->message;
    EXPECT_EQ(output->index, index);
    return std::move(*output);
  }
  std::vector<PlaneSet> expected(int first, int last) const {
    std::vector<Frame> frames;
    for (int i = first; i <= last; ++i) frames.push_back(test::small_frame(config, i));
    return test::direct(config, frames);
  }

  DenoiserConfig config = test::small_config();
  std::unique_ptr<server::Server> server;
};

/// A server whose first stream loses its session to a newer one when it has sent a frame.
class TakingOverOnce {
 public:
  TakingOverOnce() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(&sessions_);
    builder.RegisterService(&streams_);
    server_ = builder.BuildAndStart();
  }
  ~TakingOverOnce() { server_->Shutdown(std::chrono::system_clock::now()); }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  struct Sessions final : v1::SessionService::Service {
    grpc::Status CreateSession(grpc::ServerContext*, const v1::CreateSessionRequest*,
                               v1::CreateSessionResponse* response) override {
      response->set_session_id("one");
      response->add_result_planes("composite");
      return grpc::Status::OK;
    }
  };
  struct Streams final : v1::DenoiseService::Service {
    using Stream = grpc::ServerReaderWriter<v1::DenoiseResponse, v1::DenoiseRequest>;
    grpc::Status Denoise(grpc::ServerContext*, Stream* stream) override {
      for (v1::DenoiseRequest request; stream->Read(&request);) {
        v1::DenoiseResponse response;
        if (request.has_frame_end()) {
          if (frames++ == 0) return {grpc::StatusCode::ABORTED, "a newer stream has the session"};
          response.mutable_frame_result()->set_index(request.frame_end().index());
          response.mutable_frame_result()->set_dropped(true);
        }
        if (request.has_hello()) response.mutable_welcome()->set_credits(2);
        if (response.message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET)
          stream->Write(response);
      }
      return grpc::Status::OK;
    }
    std::atomic<int> frames{0};
  };
  Sessions sessions_;
  Streams streams_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

TEST_F(Reconnecting, GoesOnWhereAnOlderStreamOfItsOwnHasTakenTheSessionOver) {
  TakingOverOnce once;
  SessionOptions options;
  options.address = once.address();
  options.width = config.width;
  options.height = config.height;
  options.lights = config.lights;
  options.planes = config.planes;
  Session session(options);
  session.submit(test::small_frame(config, 0));
  EXPECT_TRUE(session.receive()->dropped);
  EXPECT_EQ(session.reconnects(), 1);
  session.close();
}

TEST_F(Reconnecting, WarmsTheHistoryOfANewServerWithTheLastFrames) {
  start();
  SessionOptions options = test::session_options(*server, config);
  options.rewarm_frames = 3;
  Session session(options);
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(pass(session, i).history_lost);
  restart();
  const FrameOutput output = pass(session, 6);
  EXPECT_TRUE(output.history_lost);
  EXPECT_FALSE(output.history_reset) << "frames 3, 4 and 5 went before it";
  EXPECT_TRUE(test::same_bits(output.planes, expected(3, 6).back()));
  EXPECT_FALSE(pass(session, 7).history_lost);
  EXPECT_EQ(session.reconnects(), 1);
  session.close();
}

TEST_F(Reconnecting, SendsWhatWasInFlightAgain) {
  start();
  SessionOptions options = test::session_options(*server, config);
  Session session(options);
  pass(session, 0);
  for (int i = 1; i <= session.credits(); ++i) session.submit(test::small_frame(config, i));
  restart();
  for (int i = 1; i <= session.credits(); ++i) {
    const auto output = session.receive();
    ASSERT_TRUE(output);
    EXPECT_EQ(output->index, i);
    EXPECT_FALSE(output->error);
  }
  EXPECT_EQ(session.in_flight(), 0);
}

TEST_F(Reconnecting, FinishesAfterALossWhatWasFinishedBefore) {
  start();
  Session session(test::session_options(*server, config));
  for (int i = 0; i < session.credits(); ++i) session.submit(test::small_frame(config, i));
  session.finish();
  restart();
  int answers = 0;
  while (session.receive()) ++answers;
  EXPECT_EQ(answers, session.credits());
  EXPECT_NO_THROW(session.close());
}

TEST_F(Reconnecting, GivesUpWhenTheNewServerRefuses) {
  start();
  Session session(test::session_options(*server, config));
  pass(session, 0);
  const std::string address = server->address();
  server.reset();
  server::ServerConfig full = test::server_config(1);
  full.listen = address;
  full.limits.max_session_bytes = 1;
  server = std::make_unique<server::Server>(full);
  EXPECT_THROW(
      {
        session.submit(test::small_frame(config, 1));
        session.receive();
      },
      client::RefusedError);
}

TEST_F(Reconnecting, StartsIndicesAgainInANewEpoch) {
  start();
  Session session(test::session_options(*server, config));
  for (int i = 0; i < 3; ++i) pass(session, i);
  session.restart();
  EXPECT_TRUE(pass(session, 0).history_reset);
  EXPECT_TRUE(test::same_bits(pass(session, 1).planes, expected(0, 1).back()));
}

}  // namespace
}  // namespace holdfast
