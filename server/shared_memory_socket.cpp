#include "server/shared_memory_socket.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/frame/error.h"
#include "holdfast/v1/shared_memory.pb.h"
#include "server/error.h"

namespace holdfast::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostRequestBytes = 4096;
constexpr int kBacklog = 64;
constexpr std::chrono::milliseconds kPause{50};  // after a failure to accept, such as no descriptor

[[noreturn]] void refuse(const std::string& path, const std::string& rule,
                         const std::string& value) {
  throw InputError("shared memory socket " + path, rule, value);
}

sockaddr_un name_of(const std::string& path) {
  sockaddr_un name{};
  if (path.empty() || path.size() >= sizeof name.sun_path)
    refuse(path, "must have a path of 1.." + std::to_string(sizeof name.sun_path - 1) + " bytes",
           std::to_string(path.size()) + " bytes");
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, path.data(), path.size());
  return name;
}

wire::Descriptor new_socket() {
  return wire::Descriptor(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

const sockaddr* address_of(const sockaddr_un& name) {
  return reinterpret_cast<const sockaddr*>(&name);
}

bool same_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

/// Sends the packet, with the descriptor unless it is negative. A caller that is gone gets nothing.
void send_packet(int socket, std::string packet, int descriptor) {
  iovec bytes{packet.data(), packet.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  if (descriptor >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &descriptor, sizeof descriptor);
  }
  sendmsg(socket, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace

void check_shared_memory_path(const std::string& path) {
  const sockaddr_un name = name_of(path);
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) refuse(path, "must be free", "a file that is no socket");
  const wire::Descriptor probe = new_socket();
  if (connect(probe.get(), address_of(name), sizeof name) == 0 || errno != ECONNREFUSED)
    refuse(path, "must be free", "in use: another program listens there");
}

SharedMemorySocket::SharedMemorySocket(std::string path, SharedMemoryOffers& offers,
                                       std::shared_ptr<spdlog::logger> log)
    : path_(std::move(path)),
      offers_(offers),
      log_(std::move(log)),
      listener_(new_socket()),
      stop_(eventfd(0, EFD_CLOEXEC)) {
  const sockaddr_un name = name_of(path_);
  check_shared_memory_path(path_);
  unlink(path_.c_str());  // of a server that is gone
  struct stat status {};
  // The mode is that of the file from its first moment on.
  if (fchmod(listener_.get(), S_IRUSR | S_IWUSR) != 0 ||
      bind(listener_.get(), address_of(name), sizeof name) != 0 ||
      listen(listener_.get(), kBacklog) != 0 || lstat(path_.c_str(), &status) != 0)
    refuse(path_, "must be a place for a socket", std::strerror(errno));
  inode_ = status.st_ino;
  thread_ = std::thread([this] { serve(); });
  log_->info("event=shared_memory_listening path={}", path_);
}

SharedMemorySocket::~SharedMemorySocket() {
  eventfd_write(stop_.get(), 1);
  thread_.join();
  struct stat status {};
  if (lstat(path_.c_str(), &status) == 0 && status.st_ino == inode_) unlink(path_.c_str());
}

void SharedMemorySocket::serve() {
  for (;;) {
    std::vector<pollfd> watched = {{stop_.get(), POLLIN, 0}, {listener_.get(), 0, 0}};
    if (callers_.size() < kMostCallers) watched[1].events = POLLIN;
    for (const Caller& caller : callers_) watched.push_back({caller.socket.get(), POLLIN, 0});
    poll(watched.data(), watched.size(),
         callers_.empty() ? -1 : static_cast<int>(kPatience.count() / 4));
    if (watched[0].revents != 0) return;
    const Clock::time_point now = Clock::now();
    for (std::size_t i = callers_.size(); i-- > 0;) {
      const bool spoke = watched[i + 2].revents != 0;
      if (spoke) answer(callers_[i].socket.get());
      if (spoke || now >= callers_[i].due)
        callers_.erase(callers_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (watched[1].revents != 0) accept_one();
  }
}

void SharedMemorySocket::accept_one() {
  wire::Descriptor caller(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!caller) {
    if (errno != EAGAIN && errno != ECONNABORTED) std::this_thread::sleep_for(kPause);
  } else if (same_user(caller.get())) {
    callers_.push_back({std::move(caller), Clock::now() + kPatience});
  } else {
    log_->warn("event=shared_memory_refused: a process of another user");
  }
}

/// Judges the packet of a caller and sends the answer.
void SharedMemorySocket::answer(int socket) {
  char packet[kMostRequestBytes];
  const ssize_t size = recv(socket, packet, sizeof packet, MSG_TRUNC);
  if (size <= 0) return;
  v1::SharedMemoryRequest request;
  v1::SharedMemoryAnswer answer;
  SharedMemoryOffers::Offer offer;
  try {
    if (size > static_cast<ssize_t>(sizeof packet) ||
        !request.ParseFromArray(packet, static_cast<int>(size)))
      throw InputError("packet", "must be a SharedMemoryRequest", "something else");
    offer = offers_.make(request.session_id(), request.token());
    answer.set_name(offer.name);
    answer.set_cells(static_cast<std::uint32_t>(offer.memory->layout().cells));
    answer.set_cell_bytes(static_cast<std::uint32_t>(offer.memory->layout().cell_bytes));
  } catch (const RefusedError& error) {
    const bool known = error.reason() == Refusal::kLimit;
    answer.set_error(known ? error.what() : "the session is unknown or has another token");
  } catch (const std::exception& error) {
    answer.set_error(error.what());
  }
  if (!answer.error().empty())
    log_->warn("event=shared_memory_refused error=\"{}\"", answer.error());
  send_packet(socket, answer.SerializeAsString(), offer.memory ? offer.memory->descriptor() : -1);
}

}  // namespace holdfast::server
