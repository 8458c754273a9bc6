#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <spdlog/logger.h>

#include "proto/shared_memory.h"
#include "server/shared_memory_offers.h"

namespace holdfast::server {

/// Throws InputError naming the path if no socket could have it, or if a server listens there.
void check_shared_memory_path(const std::string& path);

/// The side socket at which clients of the same user ask for shared memory; see
/// shared_memory.proto. One thread serves all: it never waits for one of them, and those that say
/// nothing lose their place after a second.
class SharedMemorySocket {
 public:
  /// Listens at `path`, which takes the place of a socket that nobody listens at. Throws as
  /// check_shared_memory_path, or InputError if there cannot be a socket.
  SharedMemorySocket(std::string path, SharedMemoryOffers& offers,
                     std::shared_ptr<spdlog::logger> log);
  /// Ends the thread and removes the socket.
  ~SharedMemorySocket();

  static constexpr std::size_t kMostCallers = 16;  ///< at once; more wait
  static constexpr std::chrono::milliseconds kPatience{1000};

 private:
  struct Caller {
    wire::Descriptor socket;
    std::chrono::steady_clock::time_point due;
  };

  void serve();
  void accept_one();
  void answer(int socket);

  const std::string path_;
  SharedMemoryOffers& offers_;
  const std::shared_ptr<spdlog::logger> log_;
  wire::Descriptor listener_, stop_;
  ino_t inode_ = 0;  ///< of our socket
  std::vector<Caller> callers_;
  std::thread thread_;
};

}  // namespace holdfast::server
