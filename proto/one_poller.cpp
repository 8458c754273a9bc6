#include "proto/one_poller.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>

namespace holdfast::wire {
namespace {

using namespace std::chrono_literals;

/// gRPC 1.51 has a thread for every second processor that is configured, 2 to 16 of them.
bool has_two_pollers() { return sysconf(_SC_NPROCESSORS_CONF) / 2 <= 2; }

/// One of gRPC's threads, kept in the reaction to a call that fails at once. gRPC has no option for
/// the number of its threads.
class ParkedPoller {
 public:
  ParkedPoller() {
    const grpc::Slice nothing("", 1);
    request_ = grpc::ByteBuffer(&nothing, 1);
    context_.set_deadline(std::chrono::system_clock::now() + 5s);
    stub_.UnaryCall(&context_, "/holdfast.v1.None/None", {}, &request_, &response_,
                    [place = place_](const grpc::Status&) { place->park(); });
    place_->wait_parked();
  }
  /// Lets the thread go. The end of the channel, which `context_` holds as well, may wait for it,
  /// so that it must not be the thread's own reaction that brings it about.
  ~ParkedPoller() { place_->release(); }

 private:
  /// All that the reaction touches, since it may still be returning when the object is gone.
  struct Place {
    std::mutex mutex;
    std::condition_variable changed;
    bool parked = false, released = false;

    void park() {
      std::unique_lock lock(mutex);
      parked = true;
      changed.notify_all();
      changed.wait(lock, [this] { return released; });
    }
    void wait_parked() {
      std::unique_lock lock(mutex);
      changed.wait(lock, [this] { return parked; });
    }
    void release() {
      const std::lock_guard lock(mutex);
      released = true;
      changed.notify_all();
    }
  };

  const std::shared_ptr<Place> place_ = std::make_shared<Place>();
  grpc::GenericStub stub_{
      // nobody listens there
      grpc::CreateChannel("unix:/proc/self/none", grpc::InsecureChannelCredentials())};
  grpc::ClientContext context_;
  grpc::ByteBuffer request_, response_;
};

std::atomic<bool> preferred = false;

}  // namespace

void prefer_one_poller() { preferred = true; }

std::shared_ptr<void> hold_one_poller() {
  static std::mutex mutex;
  static std::weak_ptr<ParkedPoller> held;
  if (!preferred || !has_two_pollers()) return nullptr;
  const std::lock_guard lock(mutex);
  std::shared_ptr<ParkedPoller> poller = held.lock();
  if (!poller) held = poller = std::make_shared<ParkedPoller>();
  return poller;
}

}  // namespace holdfast::wire
