#include "server/credentials.h"

#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>

namespace holdfast::server {
namespace {

constexpr unsigned kReadAgainSeconds = 5;

}  // namespace

std::shared_ptr<grpc::ServerCredentials> make_credentials(const TlsConfig& config) {
  namespace tls = grpc::experimental;
  if (config.certificate.empty()) return grpc::InsecureServerCredentials();
  const auto provider = std::make_shared<tls::FileWatcherCertificateProvider>(
      config.key, config.certificate, config.client_ca, kReadAgainSeconds);
  tls::TlsServerCredentialsOptions options(provider);
  options.watch_identity_key_cert_pairs();
  if (!config.client_ca.empty()) {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return tls::TlsServerCredentials(options);
}

}  // namespace holdfast::server
