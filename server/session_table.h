#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/config.h"
#include "server/memory_account.h"
#include "server/session.h"
#include "server/session_life.h"
#include "server/session_rates.h"
#include "server/session_watch.h"

namespace holdfast::server {

/// All sessions of a server. Knows nothing of the network; the clock can be replaced in tests.
/// Every function may be called from any thread.
class SessionTable {
 public:
  using TimePoint = SessionLife::TimePoint;
  using Clock = std::function<TimePoint()>;

  /// `frames_at_once`: frames that are filtered at the same time, at most, of all sessions.
  explicit SessionTable(SessionLimits limits, Clock clock = std::chrono::steady_clock::now,
                        int frames_at_once = 1);

  /// Makes a session with a random id and token. `owner`: the bearer token that it is made with,
  /// empty if there is none. Its memory is estimated and admitted before
  /// anything of its size is allocated, then corrected to what it is. Throws InputError for a bad
  /// configuration, RefusedError(kLimit) naming the limit.
  std::shared_ptr<Session> create(SessionConfig config, const std::string& owner = {});

  /// The session. Throws RefusedError(kUnknownSession, kWrongToken).
  std::shared_ptr<Session> find(const std::string& id, const std::string& token) const;

  /// A session held for one stream until `detach`.
  struct Attached {
    std::shared_ptr<Session> session;
    std::shared_ptr<SessionRates> rates;
    std::shared_ptr<SessionWatch> watch;
    SessionLife::Hold hold = 0;
    bool taken_over = false;  ///< from an older stream, whose hold is void now
  };
  /// Throws as `find`.
  Attached attach(const std::string& id, const std::string& token);
  /// Ends the hold; the session then lingers. No effect if the hold is void or the session removed.
  void detach(const Session& session, SessionLife::Hold hold);

  /// Reserves the memory for a change of the session, which has both configurations at once while
  /// it follows. Throws as `create`; what the session has is then as before. The memory is
  /// accounted until the reservation dies, which corrects the account of the session to what it has
  /// by then. The table must outlive it.
  std::shared_ptr<void> reserve(const std::shared_ptr<Session>& session,
                                const SessionConfig& config);

  /// Ends a session at once. Throws as `find`.
  void remove(const std::string& id, const std::string& token);
  /// Ends the sessions that have lingered too long; their number.
  int expire();

  bool attached(const Session& session) const;
  /// What is known of one session from outside.
  struct Listed {
    std::shared_ptr<const Session> session;
    std::shared_ptr<SessionWatch> watch;
    std::size_t bytes = 0;
    bool streaming = false;
  };
  /// All sessions, in the order in which they were made.
  std::vector<Listed> list() const;
  /// Bytes accounted to the session, what it shares not included; 0 if it was removed.
  std::size_t bytes(const Session& session) const;
  std::size_t size() const;
  /// Accounted to all sessions, each by itself; to the scratch that they share; and both.
  std::size_t session_bytes() const;
  std::size_t scratch_bytes() const;
  std::size_t total_bytes() const;
  /// Share of the filtering threads' time that sessions which have told their rate take: by the
  /// time of their frames, where enough are known, else as expected of others like them.
  double load() const;
  const SessionLimits& limits() const { return limits_; }

 private:
  struct Entry {
    std::shared_ptr<Session> session;  ///< null while it is being made
    SessionBytes bytes;
    std::size_t reserved = 0;  ///< of its own for changes under way
    double load = 0;           ///< SessionConfig::load, the greater one while it changes
    double rate = 0;           ///< told, if it goes with one preset; else 0
    SessionLife life;
    std::string owner;  ///< a secret: compared, never shown
    std::shared_ptr<SessionRates> rates;
    std::shared_ptr<SessionWatch> watch;
  };

  Entry& live_entry(const std::string& id);
  const Entry& checked(const std::string& id, const std::string& token) const;
  void admit(const std::string& id, SessionBytes bytes, const SessionConfig& config,
             const std::string& owner);
  void check_count(const std::string& owner) const;
  void settle(Entry& entry, SessionBytes bytes);
  void end_reservation(const Session& session, SessionBytes reserved);
  SessionBytes needed_bytes(const SessionConfig& session) const;
  SessionBytes with_frames(const SessionConfig& session, SessionBytes denoiser) const;
  void check_bytes(SessionBytes bytes) const;
  void check_load(double more) const;
  /// What sessions take that tell their rate, and how that is to what was expected of them.
  struct Loads {
    double sum = 0, correction = 1;
  };
  Loads loads() const;

  const SessionLimits limits_;
  const Clock clock_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  MemoryAccount account_;
  const std::shared_ptr<ScratchPool> scratch_ = std::make_shared<ScratchPool>();
  int made_ = 0;  ///< sessions asked for so far
};

}  // namespace holdfast::server
