#include "server/shared_memory_offers.h"

#include <utility>

#include "server/error.h"
#include "server/random_token.h"

namespace holdfast::server {
namespace {

constexpr int kNameBytes = 16;  // 128 bits: not to be guessed

/// Nobody has written to it or will read it, though the client may keep it mapped.
void discard(const wire::SharedMemory& memory) {
  memory.discard(wire::SharedPart::kInput);
  memory.discard(wire::SharedPart::kResults);
}

}  // namespace

SharedMemoryOffers::Offer SharedMemoryOffers::make(const std::string& session_id,
                                                   const std::string& token) {
  const auto session = sessions_.find(session_id, token);
  if (!session->config()->shared_memory)
    throw RefusedError("the session was not made with shared memory", Quota{"shared-memory", {}});
  drop_others(session_id);  // the account has room for one
  Offer offer{random_hex(kNameBytes), wire::SharedMemory::make()};
  const std::lock_guard lock(mutex_);
  waiting_[session_id] = {session, offer};
  return offer;
}

/// Those of the session, and of sessions that are gone.
void SharedMemoryOffers::drop_others(const std::string& session_id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const auto& entry) {
    const bool over = entry.second.session.expired() || entry.first == session_id;
    if (over) discard(*entry.second.offer.memory);
    return over;
  });
}

std::shared_ptr<wire::SharedMemory> SharedMemoryOffers::take(const Session& session,
                                                             const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto it = waiting_.find(session.id());
  if (it == waiting_.end() || !equal_secrets(it->second.offer.name, name)) return nullptr;
  auto memory = std::move(it->second.offer.memory);
  waiting_.erase(it);
  return memory;
}

}  // namespace holdfast::server
