#include "server/config.h"

#include <unistd.h>

#include "core/frame/error.h"
#include "server/listen_address.h"
#include "server/log.h"
#include "server/shared_memory_socket.h"

namespace holdfast::server {
namespace {

template <class T>
void at_least(const char* subject, T value, T least) {
  if (value < least)
    throw InputError(subject, "must be at least " + std::to_string(least), std::to_string(value));
}

void check_file(const char* subject, const std::string& file) {
  if (!file.empty() && access(file.c_str(), R_OK) != 0)
    throw InputError(std::string(subject) + " " + file, "must be a file that can be read",
                     "not readable");
}

void check_local(const char* subject, const std::string& address, bool allow_remote) {
  if (!allow_remote && !is_local_address(address))
    throw InputError(std::string(subject) + " " + address,
                     "must be an address of this machine alone, unless --allow-remote is given",
                     "reachable from elsewhere");
}

}  // namespace

void check_config(const ServerConfig& config) {
  at_least("threads", config.threads, 0);
  at_least("credits", config.limits.credits, 1);
  at_least("max dimension", config.limits.max_dimension, 1);
  at_least("keepalive", config.keepalive.count(), decltype(config.keepalive)::rep{1000});
  at_least("keepalive timeout", config.keepalive_timeout.count(),
           decltype(config.keepalive)::rep{100});
  make_logger(config.log_level);
  check_address_form(config.listen);
  check_local("listen address", config.listen, config.allow_remote);
  if (!config.shared_memory.empty()) check_shared_memory_path(config.shared_memory);
  if (!config.shared_memory.empty() && config.listen == "unix:" + config.shared_memory)
    throw InputError("shared memory socket", "must be another than the listen address",
                     config.shared_memory);
  if (!config.admin.empty()) {
    check_address_form(config.admin);
    if (config.admin.starts_with("unix:"))
      throw InputError("admin address", "must be host:port", config.admin);
    check_local("admin address", config.admin, config.allow_remote);
  }
  if (config.tls.certificate.empty() != config.tls.key.empty())
    throw InputError("TLS", "must have both a certificate and a key", "one of them");
  if (!config.tls.client_ca.empty() && config.tls.certificate.empty())
    throw InputError("TLS client authorities", "must come with a certificate and a key", "alone");
  check_file("TLS certificate", config.tls.certificate);
  check_file("TLS key", config.tls.key);
  check_file("TLS client authorities", config.tls.client_ca);
  check_file("token file", config.token_file);
  if (config.limits.max_sessions_per_token > 0 && config.token_file.empty())
    throw InputError("limit of sessions for each token", "must come with a token file", "alone");
  if (!(config.limits.max_load >= 0 && config.limits.max_load <= 1))
    throw InputError("limit of the load", "must be in 0..1",
                     std::to_string(config.limits.max_load));
  if (!(config.limits.max_frames_per_second >= 0))
    throw InputError("frames per second", "must be at least 0",
                     std::to_string(config.limits.max_frames_per_second));
}

}  // namespace holdfast::server
