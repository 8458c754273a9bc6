#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "proto/shared_memory.h"
#include "server/session_table.h"

namespace holdfast::server {

/// Shared memory that was made for sessions and that no stream uses yet: at most one for each
/// session. Every function may be called from any thread.
class SharedMemoryOffers {
 public:
  explicit SharedMemoryOffers(SessionTable& sessions) : sessions_(sessions) {}

  struct Offer {
    std::string name;  ///< not to be guessed
    std::shared_ptr<wire::SharedMemory> memory;
  };
  /// Makes memory for the next stream of the session, in place of what was offered before. Throws
  /// RefusedError (kUnknownSession, kWrongToken, or kLimit for a session that did not ask for it
  /// when it was made), std::system_error if there is no memory.
  Offer make(const std::string& session_id, const std::string& token);
  /// What was offered under that name, for a stream of the session; null if it is not there.
  std::shared_ptr<wire::SharedMemory> take(const Session& session, const std::string& name);

 private:
  struct Waiting {
    std::weak_ptr<const Session> session;
    Offer offer;
  };

  void drop_others(const std::string& session_id);

  SessionTable& sessions_;
  std::mutex mutex_;
  std::map<std::string, Waiting> waiting_;  ///< by session
};

}  // namespace holdfast::server
