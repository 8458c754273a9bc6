#include "server/stream_registry.h"

#include <algorithm>

#include "server/denoise_stream.h"
#include "server/error.h"
#include "server/peer.h"

namespace holdfast::server {
namespace {

constexpr std::chrono::milliseconds kRetryStream{1000};

}  // namespace

void StreamRegistry::add(const std::shared_ptr<DenoiseStream>& stream, const std::string& peer) {
  const std::string network = most_waiting_ > 0 ? peer_network(peer) : std::string();
  const std::lock_guard lock(mutex_);
  if (draining_) throw RefusedError(Refusal::kDraining, "the server is shutting down");
  if (streams_.size() >= most_)
    throw RefusedError("the server has " + std::to_string(most_) + " streams, the most it allows",
                       {"max-streams", kRetryStream});
  const auto of_peer = [&](const auto& entry) { return entry.second.waiting == network; };
  if (!network.empty() && std::count_if(streams_.begin(), streams_.end(), of_peer) >=
                              static_cast<std::ptrdiff_t>(most_waiting_))
    throw RefusedError(
        std::to_string(most_waiting_) +
            " streams of this address have not said Hello, the most the server allows",
        {"max-waiting-per-address", kRetryStream});
  streams_[stream.get()] = {stream, network};
}

void StreamRegistry::greeted(const DenoiseStream* stream) {
  const std::lock_guard lock(mutex_);
  const auto it = streams_.find(stream);
  if (it != streams_.end()) it->second.waiting.clear();
}

std::size_t StreamRegistry::size() const {
  const std::lock_guard lock(mutex_);
  return streams_.size();
}

void StreamRegistry::remove(const DenoiseStream* stream) {
  const std::lock_guard lock(mutex_);
  streams_.erase(stream);
  if (streams_.empty()) empty_.notify_all();
}

std::vector<std::shared_ptr<DenoiseStream>> StreamRegistry::all() const {
  std::vector<std::shared_ptr<DenoiseStream>> out;
  const std::lock_guard lock(mutex_);
  for (const auto& [key, entry] : streams_)
    if (auto stream = entry.stream.lock()) out.push_back(std::move(stream));
  return out;
}

void StreamRegistry::close_session(const std::string& session_id) {
  for (const auto& stream : all())
    if (stream->session_id() == session_id)
      stream->close({grpc::StatusCode::NOT_FOUND, "session " + session_id + " was deleted"});
}

void StreamRegistry::take_over(const std::string& session_id, SessionLife::Hold hold) {
  for (const auto& stream : all())
    if (stream->session_id() == session_id) stream->yield(hold);
}

void StreamRegistry::tick(std::chrono::steady_clock::time_point now) {
  for (const auto& stream : all()) stream->tick(now);
}

void StreamRegistry::drain(std::chrono::milliseconds deadline) {
  {
    const std::lock_guard lock(mutex_);
    draining_ = true;
  }
  for (const auto& stream : all()) stream->drain(deadline);
}

bool StreamRegistry::wait_empty(std::chrono::milliseconds deadline) {
  std::unique_lock lock(mutex_);
  return empty_.wait_for(lock, deadline, [this] { return streams_.empty(); });
}

}  // namespace holdfast::server
