#include "client/sdk/shared_memory.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <optional>
#include <stdexcept>

#include "core/frame/error.h"
#include "holdfast/v1/shared_memory.pb.h"

namespace holdfast::client {
namespace {

constexpr std::size_t kMostAnswerBytes = 4096;
constexpr timeval kPatience{1, 0};  // to get a place at the socket, and for its answer

wire::Descriptor connected(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, path.data(), path.size());
  wire::Descriptor socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  ucred peer{};
  socklen_t size = sizeof peer;
  const int fd = socket.get();
  const bool good = setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience) == 0 &&
                    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience) == 0 &&
                    connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0 &&
                    getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
                    (peer.uid == geteuid() || peer.uid == 0);
  return good ? std::move(socket) : wire::Descriptor();
}

/// One packet, and the descriptor that came with it; nothing if none came or it is too long.
std::optional<std::string> receive(int socket, wire::Descriptor& descriptor) {
  std::string packet(kMostAnswerBytes, 0);
  iovec bytes{packet.data(), packet.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  if (size <= 0) return {};
  const cmsghdr* const header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS &&
      header->cmsg_len == CMSG_LEN(sizeof(int))) {
    int fd = -1;
    std::memcpy(&fd, CMSG_DATA(header), sizeof fd);
    descriptor = wire::Descriptor(fd);
  }
  if ((message.msg_flags & MSG_TRUNC) != 0) return {};
  packet.resize(static_cast<std::size_t>(size));
  return packet;
}

}  // namespace

void check_shared_memory_path(const std::string& path) {
  constexpr std::size_t kMost = sizeof(sockaddr_un::sun_path) - 1;
  if (path.size() > kMost)
    throw InputError("shared_memory",
                     "must be a path of at most " + std::to_string(kMost) + " bytes",
                     std::to_string(path.size()) + " bytes");
}

SharedMemoryOffer ask_for_shared_memory(const std::string& path, const std::string& session_id,
                                        const std::string& token) try {
  const wire::Descriptor socket = connected(path);
  if (!socket) return {};
  v1::SharedMemoryRequest request;
  request.set_session_id(session_id);
  request.set_token(token);
  const std::string packet = request.SerializeAsString();
  if (send(socket.get(), packet.data(), packet.size(), MSG_NOSIGNAL) < 0) return {};
  wire::Descriptor descriptor;
  const std::optional<std::string> received = receive(socket.get(), descriptor);
  v1::SharedMemoryAnswer answer;
  if (!received || !descriptor || !answer.ParseFromString(*received) || !answer.error().empty())
    return {};
  return {answer.name(),
          wire::SharedMemory::map(descriptor.get(), {answer.cells(), answer.cell_bytes()})};
} catch (const std::runtime_error&) {  // not what it should be: not used
  return {};
}

}  // namespace holdfast::client
