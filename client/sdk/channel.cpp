#include "client/sdk/channel.h"

#include <fstream>
#include <sstream>

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "proto/plane_bytes.h"

namespace holdfast::client {
namespace {

constexpr int kHttp2FrameBytes = 1 << 20;  // fewer, larger frames: less CPU for large messages

// A server that is frozen, or gone without a word, is noticed after the sum of these.
constexpr int kKeepaliveMs = 10000;
constexpr int kKeepaliveTimeoutMs = 5000;

// gRPC waits a second before it connects again; a game cannot.
constexpr int kFirstBackoffMs = 50;
constexpr int kLongestBackoffMs = 1000;

std::string file_text(const char* subject, const std::string& file) {
  if (file.empty()) return {};
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  if (text.str().empty())
    throw InputError(std::string(subject) + " " + file, "must be a file that can be read",
                     "missing or empty");
  return text.str();
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const TlsFiles& files) {
  if (files.ca.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions options;
  options.pem_root_certs = file_text("TLS authorities", files.ca);
  options.pem_cert_chain = file_text("TLS certificate", files.certificate);
  options.pem_private_key = file_text("TLS key", files.key);
  return grpc::SslCredentials(options);
}

}  // namespace

std::shared_ptr<grpc::Channel> make_channel(const SessionOptions& session) {
  const std::string& address = session.address;
  grpc::ChannelArguments args;
  args.SetMaxReceiveMessageSize(wire::kMaxMessageBytes);
  args.SetInt(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kHttp2FrameBytes);
  args.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // one connection for each session
  args.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  args.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  args.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  args.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  args.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstBackoffMs);
  args.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kLongestBackoffMs);
  // The probe finds the window of a long link; a unix socket has none to find.
  if (address.starts_with("unix:")) {
    args.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    args.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, wire::kMaxMessageBytes);
  }
  return grpc::CreateCustomChannel(address, credentials(session.tls), args);
}

}  // namespace holdfast::client
