#include "client/sdk/channel.h"

#include <fstream>
#include <sstream>

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "core/frame/error.h"
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

/// The text of a PEM file that holds a `what`, such as "CERTIFICATE".
std::string pem_text(const char* subject, const std::string& file, const char* what) {
  if (file.empty()) return {};
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const std::string name = std::string(subject) + " " + file;
  if (text.str().empty())
    throw InputError(name, "must be a file that can be read", "missing or empty");
  // Not a parser: it tells a wrong file from a right one, also a key from a certificate.
  if (text.str().find("-----BEGIN ") == std::string::npos ||
      text.str().find(std::string(what) + "-----") == std::string::npos)
    throw InputError(name, std::string("must hold a ") + what + " in PEM form", "without one");
  return text.str();
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const TlsFiles& files) {
  if (files.certificate.empty() != files.key.empty())
    throw InputError("TLS of a client", "must have both a certificate and a key, or neither",
                     "one of them");
  if (files.ca.empty() && !files.key.empty())
    throw InputError("TLS of a client", "must have the authorities of the server",
                     "a certificate alone");
  if (files.ca.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions options;
  options.pem_root_certs = pem_text("TLS authorities", files.ca, "CERTIFICATE");
  options.pem_cert_chain = pem_text("TLS certificate", files.certificate, "CERTIFICATE");
  options.pem_private_key = pem_text("TLS key", files.key, "PRIVATE KEY");
  return grpc::SslCredentials(options);
}

/// A bearer token is the value of a header, which can carry no others.
void check_token(const std::string& token) {
  for (const char c : token)
    if (c <= ' ' || c > '~')
      throw InputError("bearer token", "must be of visible ASCII characters", "with others");
}

bool is_local(const std::string& address) {
  return address.starts_with("unix:") || address.starts_with("127.") ||
         address.starts_with("localhost:") || address.starts_with("[::1]:");
}

}  // namespace

std::shared_ptr<grpc::Channel> make_channel(const SessionOptions& session) {
  const std::string& address = session.address;
  check_token(session.bearer_token);
  grpc::ChannelArguments args;
  args.SetMaxReceiveMessageSize(wire::kMaxMessageBytes);
  args.SetInt(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, kHttp2FrameBytes);
  args.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // one connection for each session
  args.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  // A stream that begins just as its connection is lost is repeated by gRPC on the next one, and
  // all its later writes are then reported as failed although they are sent (1.51). The keeper
  // opens another one itself.
  args.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);
  args.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  args.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  args.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  args.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstBackoffMs);
  args.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kLongestBackoffMs);
  // The probe finds the window of a long link; within a machine it finds far too large a one.
  if (is_local(address)) {
    args.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    args.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, wire::kMaxMessageBytes);
  }
  if (!session.tls.server_name.empty()) args.SetSslTargetNameOverride(session.tls.server_name);
  return grpc::CreateCustomChannel(address, credentials(session.tls), args);
}

}  // namespace holdfast::client
