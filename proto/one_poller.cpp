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

/// A thread of gRPC that has waited for a second without an event looks away for a tenth of one.
constexpr auto kPing = 400ms;

/// Its calls fail at once. It shares no attempts to connect with other channels, whose pauses
/// between attempts its calls would have to wait for.
std::shared_ptr<grpc::Channel> channel_to_nobody() {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel("unix:/proc/self/none", grpc::InsecureChannelCredentials(),
                                   arguments);
}

/// One of gRPC's threads, kept in the reaction to a call that fails at once, where it makes such
/// calls now and then: their reactions keep the other thread from looking away. gRPC has no option
/// for the number of its threads.
class ParkedPoller {
 public:
  ParkedPoller() {
    call(context_, [this] { stay(); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return parked_; });
  }
  /// Lets the thread go, and waits until it touches nothing of this any more. The end of the last
  /// context ends the channel, which waits for gRPC's threads, so that it must not be one of
  /// theirs.
  ~ParkedPoller() {
    std::unique_lock lock(mutex_);
    released_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !parked_; });
  }

 private:
  /// Has a thread of gRPC call `reaction`.
  template <class Reaction>
  void call(grpc::ClientContext& context, Reaction reaction) {
    context.set_deadline(std::chrono::system_clock::now() + 5s);
    stub_.UnaryCall(&context, "/holdfast.v1.None/None", {}, &nothing_, &answer_,
                    [reaction](const grpc::Status&) { reaction(); });
  }

  void stay() {
    std::unique_lock lock(mutex_);
    parked_ = true;
    changed_.notify_all();
    while (!changed_.wait_for(lock, kPing, [this] { return released_; })) {
      grpc::ClientContext context;
      bool answered = false;
      lock.unlock();
      call(context, [this, &answered] {
        const std::lock_guard guard(mutex_);
        answered = true;
        changed_.notify_all();
      });
      lock.lock();
      changed_.wait(lock, [&] { return answered; });
    }
    parked_ = false;
    changed_.notify_all();
  }

  grpc::GenericStub stub_{channel_to_nobody()};
  const grpc::Slice byte_{"", 1};
  const grpc::ByteBuffer nothing_{&byte_, 1};
  grpc::ByteBuffer answer_;  ///< never filled: all calls fail
  grpc::ClientContext context_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool parked_ = false, released_ = false;
};

std::atomic<bool> preferred = false;

}  // namespace

void prefer_one_poller() { preferred = true; }

std::shared_ptr<void> hold_one_poller() {
  // Whoever lets go last ends the poller before another one is made: two would keep both threads.
  static std::mutex mutex;
  static int holders = 0;
  static auto& poller = *new std::unique_ptr<ParkedPoller>;  // outlives whoever holds it at exit
  if (!preferred || !has_two_pollers()) return nullptr;
  const std::lock_guard lock(mutex);
  if (!poller) poller = std::make_unique<ParkedPoller>();
  ++holders;
  return {poller.get(), [](void*) {
            const std::lock_guard guard(mutex);
            if (--holders == 0) poller.reset();
          }};
}

}  // namespace holdfast::wire
