#include "server/embedded.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "server/server.h"

namespace holdfast::server {
namespace {

/// A directory that only this user can enter, removed with its content at the end.
class PrivateDirectory {
 public:
  PrivateDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "holdfast-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
      throw std::system_error(errno, std::generic_category(), "cannot make " + pattern);
    path_ = pattern;
  }
  ~PrivateDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

ServerConfig config_for(const std::filesystem::path& dir, int threads, const std::string& level,
                        EmbeddedServer::Link link) {
  ServerConfig config;
  config.listen =
      link == EmbeddedServer::Link::kTcp ? "127.0.0.1:0" : "unix:" + (dir / "socket").string();
  if (link == EmbeddedServer::Link::kSharedMemory) config.shared_memory = (dir / "memory").string();
  config.threads = threads;
  config.log_level = level;
  return config;
}

}  // namespace

class EmbeddedServer::Impl {
 public:
  Impl(int threads, const std::string& log_level, Link link)
      : config(config_for(directory.path(), threads, log_level, link)), server(config) {}
  const PrivateDirectory directory;
  const ServerConfig config;
  Server server;
};

EmbeddedServer::EmbeddedServer(int threads, const std::string& log_level, Link link)
    : impl_(std::make_unique<Impl>(threads, log_level, link)) {}
EmbeddedServer::~EmbeddedServer() = default;
const std::string& EmbeddedServer::address() const { return impl_->server.address(); }
const std::string& EmbeddedServer::shared_memory() const { return impl_->config.shared_memory; }

}  // namespace holdfast::server
