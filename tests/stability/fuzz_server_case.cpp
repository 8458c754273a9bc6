#include "tests/stability/fuzz_server_case.h"

#include <exception>
#include <optional>

#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"
#include "tests/stability/fuzz_message.h"

namespace holdfast::test {
namespace {

constexpr std::chrono::seconds kLongestStream{20};

/// A Denoise stream that writes and reads any bytes.
class ByteStream {
 public:
  explicit ByteStream(RawClient& client)
      : method_("/holdfast.v1.DenoiseService/Denoise", grpc::internal::RpcMethod::BIDI_STREAMING,
                client.channel) {
    context_.set_deadline(std::chrono::system_clock::now() + kLongestStream);
    stream_.reset(
        grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>::Create(
            client.channel.get(), method_, &context_));
  }
  bool write(const grpc::ByteBuffer& bytes) { return stream_->Write(bytes); }
  void cancel() { context_.TryCancel(); }

  /// Reads to the end, at which the status is.
  template <class Take>
  grpc::Status finish(const Take& take) {
    stream_->WritesDone();
    for (grpc::ByteBuffer bytes; stream_->Read(&bytes);) take(bytes);
    return stream_->Finish();
  }

 private:
  grpc::internal::RpcMethod method_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> stream_;
};

std::string hello_of(const RawClient& client) {
  v1::DenoiseRequest request;
  request.mutable_hello()->set_session_id(client.session.session_id());
  request.mutable_hello()->set_token(client.session.token());
  return request.SerializeAsString();
}

bool may_end_so(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::OK:
    case grpc::StatusCode::INVALID_ARGUMENT:
    case grpc::StatusCode::NOT_FOUND:
    case grpc::StatusCode::PERMISSION_DENIED:
    case grpc::StatusCode::CANCELLED: return true;
    default: return false;
  }
}

/// A frame that any history takes: of a new epoch, and of the size that the session was made with.
std::vector<v1::DenoiseRequest> whole_frame(const DenoiserConfig& config, std::uint64_t epoch) {
  std::vector<v1::DenoiseRequest> messages = RawStream::messages(small_frame(config, 0), config);
  v1::FrameBegin& begin = *messages.front().mutable_frame_begin();
  begin.set_epoch(epoch);
  begin.mutable_change()->set_width_px(static_cast<std::uint32_t>(config.width));
  begin.mutable_change()->set_height_px(static_cast<std::uint32_t>(config.height));
  return messages;
}

}  // namespace

class ServerFuzz::Impl {
 public:
  Impl() : server_(quiet_config()), config_(small_config(19, 11)), core_(config_) {
    session_.emplace(session_options(server_, config_));
  }

  ReadOutcome run(std::uint32_t seed) {
    ReadOutcome outcome;
    Random random(seed);
    const DenoiserConfig config = fuzz_session_config(random);
    RawClient client(server_.address());
    if (!client.create(config).ok()) return {"no session can be made", 0, 0};
    outcome.problem = hostile(client, config, random, outcome);
    if (outcome.problem.empty()) outcome.problem = again(client, config);
    if (outcome.problem.empty()) outcome.problem = healthy();
    v1::DeleteSessionRequest request;
    request.set_session_id(client.session.session_id());
    request.set_token(client.session.token());
    grpc::ClientContext context;
    v1::DeleteSessionResponse response;
    client.sessions->DeleteSession(&context, request, &response);
    return outcome;
  }

 private:
  static server::ServerConfig quiet_config() {
    server::ServerConfig config = server_config(1);
    config.listen = socket_address().address();
    return config;
  }
  static const SocketAddress& socket_address() {
    static const SocketAddress address;
    return address;
  }

  static std::string hostile(RawClient& client, const DenoiserConfig& config, Random& random,
                             ReadOutcome& outcome) {
    ByteStream stream(client);
    std::vector<std::string> messages{hello_of(client)};
    if (chance(random, 0.1)) messages = damaged_messages(messages, random);
    for (std::size_t n = 1 + below(random, 3); n > 0; --n) {
      const Frame frame = small_frame(config, static_cast<std::int64_t>(3 - n));
      std::vector<std::string> more = frame_messages(frame, config, any_wire(random));
      if (chance(random, 0.7)) more = damaged_messages(std::move(more), random);
      messages.insert(messages.end(), more.begin(), more.end());
    }
    for (const std::string& message : messages)
      if (!stream.write(in_pieces(message, random))) break;
    if (chance(random, 0.2)) stream.cancel();
    std::string problem;
    const grpc::Status status = stream.finish([&](grpc::ByteBuffer& bytes) {
      v1::DenoiseResponse response;
      if (!wire::parse_message(bytes, response)) problem = "an answer cannot be read";
      if (!response.has_frame_result()) return;
      const v1::FrameResult& result = response.frame_result();
      ++(result.has_error() ? outcome.refused : outcome.accepted);
      if (result.has_error() && result.error().code() == v1::FRAME_ERROR_CODE_INTERNAL)
        problem = "the server failed: " + result.error().message();
    });
    if (problem.empty() && !may_end_so(status.error_code()))
      problem = "the stream ended with " + std::to_string(status.error_code()) + ", " +
                status.error_message();
    return problem;
  }

  /// The session goes on. A stream that was cancelled may still take it once, where its Hello is
  /// read after ours.
  static std::string again(RawClient& client, const DenoiserConfig& config) {
    grpc::Status status;
    for (int attempt = 0; attempt < 2; ++attempt) {
      RawStream stream(client);
      const v1::Welcome welcome = stream.attach();
      if (welcome.credits() > 0 && welcome.epoch() == ~0ull) return {};  // there is no later one
      for (const v1::DenoiseRequest& message : whole_frame(config, welcome.epoch() + 1))
        if (!stream.write(message)) break;
      stream.writes_done();
      const v1::FrameResult result = stream.read_result();
      if (result.has_error()) return "a whole frame is refused: " + result.error().message();
      if (!result.planes().empty()) return {};
      while (stream.read().message_case() != v1::DenoiseResponse::MESSAGE_NOT_SET) {
      }
      status = stream.finish();
      if (status.error_code() != grpc::StatusCode::ABORTED) break;
    }
    return "a whole frame has no answer: " + status.error_message();
  }

  /// And so does everybody else's.
  std::string healthy() {
    const auto frame = std::make_shared<const Frame>(small_frame(config_, index_++));
    session_->submit(frame);
    const auto output = session_->receive();
    if (!output || output->error) return "the healthy session has no answer";
    PlaneSet expected;
    core_.filter(*frame, expected);
    if (!same_bits(output->planes, expected)) return "the healthy session has another answer";
    return session_->reconnects() > 0 ? "the healthy session was cut" : "";
  }

  server::Server server_;
  const DenoiserConfig config_;
  Denoiser core_;
  std::optional<client::Session> session_;
  std::int64_t index_ = 0;
};

ServerFuzz::ServerFuzz() : impl_(std::make_unique<Impl>()) {}
ServerFuzz::~ServerFuzz() = default;

ReadOutcome ServerFuzz::run(std::uint32_t seed) {
  try {
    return impl_->run(seed);
  } catch (const std::exception& error) {
    return {std::string("it threw: ") + error.what(), 0, 0};
  }
}

}  // namespace holdfast::test
