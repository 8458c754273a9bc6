#include "proto/unix_buffers.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <charconv>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace holdfast::wire {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnix = "unix:";
constexpr int kAsked = 512 << 10;  // bytes; the kernel doubles it, for its own bookkeeping

using NameOf = int (*)(int, sockaddr*, socklen_t*);  // getsockname or getpeername

/// Which file it is, by whatever path; what stat() says of sockets, which `fs::equivalent` refuses.
std::optional<std::pair<dev_t, ino_t>> file_at(const char* path) {
  struct stat info {};
  if (stat(path, &info) != 0) return std::nullopt;
  return std::pair(info.st_dev, info.st_ino);
}

/// Whether that name of the socket is the file.
bool has_name(int fd, NameOf name_of, std::pair<dev_t, ino_t> file) {
  sockaddr_un name{};
  socklen_t size = sizeof name;
  if (name_of(fd, reinterpret_cast<sockaddr*>(&name), &size) != 0) return false;  // no socket
  if (name.sun_family != AF_UNIX || size <= offsetof(sockaddr_un, sun_path)) return false;
  return file_at(
             std::string(name.sun_path, strnlen(name.sun_path, sizeof name.sun_path)).c_str()) ==
         file;
}

void widen(int fd) {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  if (getsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, &size) == 0 && bytes < 2 * kAsked)
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kAsked, sizeof kAsked);
}

}  // namespace

void widen_unix_buffers(const std::string& address) {
  if (!address.starts_with(kUnix)) return;
  const auto file = file_at(address.c_str() + std::strlen(kUnix));
  if (!file) return;
  std::error_code error;
  for (fs::directory_iterator at("/proc/self/fd", error), end; !error && at != end;
       at.increment(error)) {
    const std::string number = at->path().filename();
    int fd = -1;
    std::from_chars(number.data(), number.data() + number.size(), fd);
    // The socket that listens has the server's name too; its buffer does not matter.
    if (has_name(fd, getsockname, *file) || has_name(fd, getpeername, *file)) widen(fd);
  }
}

}  // namespace holdfast::wire
