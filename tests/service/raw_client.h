#pragma once

#include <memory>
#include <string>

#include <grpcpp/grpcpp.h>

#include "client/sdk/convert.h"
#include "client/sdk/frame_sender.h"
#include "holdfast/v1/denoise_service.grpc.pb.h"
#include "holdfast/v1/session_service.grpc.pb.h"
#include "proto/plane_bytes.h"
#include "tests/service/test_frames.h"

namespace holdfast::test {

/// A client made of the generated code alone, which can say what the library never would.
class RawClient {
 public:
  explicit RawClient(const std::string& address)
      : channel(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())),
        sessions(v1::SessionService::NewStub(channel)),
        denoise(v1::DenoiseService::NewStub(channel)) {}

  grpc::Status create(const DenoiserConfig& config,
                      v1::LateFrames late_frames = v1::LATE_FRAMES_ALL) {
    client::SessionOptions options;
    options.width = config.width;
    options.height = config.height;
    options.lights = config.lights;
    options.planes = config.planes;
    v1::CreateSessionRequest request;
    client::write_create_request(options, request);
    request.set_late_frames(late_frames);
    grpc::ClientContext context;
    return sessions->CreateSession(&context, request, &session);
  }

  v1::GetSessionResponse get() {
    v1::GetSessionRequest request;
    request.set_session_id(session.session_id());
    request.set_token(session.token());
    v1::GetSessionResponse response;
    grpc::ClientContext context;
    const grpc::Status status = sessions->GetSession(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response;
  }

  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::SessionService::Stub> sessions;
  std::unique_ptr<v1::DenoiseService::Stub> denoise;
  v1::CreateSessionResponse session;
};

/// One Denoise stream of a RawClient.
class RawStream {
 public:
  explicit RawStream(RawClient& client) : client_(client) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(240));
    stream_ = client.denoise->Denoise(&context_);
  }

  void hello(const std::string& session, const std::string& token) {
    v1::DenoiseRequest request;
    request.mutable_hello()->set_session_id(session);
    request.mutable_hello()->set_token(token);
    stream_->Write(request);
  }
  /// Hello and Welcome.
  v1::Welcome attach() {
    hello(client_.session.session_id(), client_.session.token());
    return read().welcome();
  }
  bool write(const v1::DenoiseRequest& request) { return stream_->Write(request); }
  bool write(const Frame& frame, const DenoiserConfig& config) {
    for (const v1::DenoiseRequest& message : messages(frame, config))
      if (!write(message)) return false;
    return true;
  }
  void writes_done() { stream_->WritesDone(); }
  void cancel() { context_.TryCancel(); }

  /// The next message; empty at the end of the stream.
  v1::DenoiseResponse read() {
    v1::DenoiseResponse response;
    if (!stream_->Read(&response)) response.Clear();
    return response;
  }
  /// The next FrameResult; chunks are read over.
  v1::FrameResult read_result() {
    for (;;) {
      const v1::DenoiseResponse response = read();
      if (!response.has_plane_chunk()) return response.frame_result();
    }
  }
  grpc::Status finish() { return stream_->Finish(); }

  static std::vector<v1::DenoiseRequest> messages(const Frame& frame, const DenoiserConfig& config,
                                                  const char* wire = "exact") {
    std::vector<v1::DenoiseRequest> out;
    client::PlaneWriter writer{wire::find_profile(wire), {}};
    client::FrameSender sender({{&frame, [](const Frame*) {}}, 0, {}, {}}, config.planes, writer);
    wire::OutgoingMessage message;
    while (sender.next(message)) wire::parse_message(message.bytes, out.emplace_back());
    return out;
  }

 private:
  RawClient& client_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::DenoiseRequest, v1::DenoiseResponse>> stream_;
};

}  // namespace holdfast::test
