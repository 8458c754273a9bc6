#include "server/session_table.h"

#include <algorithm>
#include <cmath>

#include "core/frame/error.h"
#include "server/error.h"
#include "server/random_token.h"
#include "server/transport_memory.h"

namespace holdfast::server {
namespace {

constexpr int kIdBytes = 8;      // enough to be unique; not a secret
constexpr int kTokenBytes = 16;  // 128 bits: not to be guessed

constexpr double kMostCorrected = 4;  // of what is expected of a session, either way

/// The rate of a session whose frames all take the same time; 0 if it has told none.
double fixed_rate(const SessionConfig& config) {
  return config.budget_ms > 0 ? 0 : config.frames_per_second;
}

std::string percent(double share) {
  return std::to_string(std::lround(100 * std::min(share, 1e9))) + " %";
}

std::string mib(std::size_t bytes) {
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB";
}

}  // namespace

SessionTable::SessionTable(SessionLimits limits, Clock clock, int frames_at_once)
    : limits_(limits), clock_(std::move(clock)), account_(frames_at_once) {}

std::shared_ptr<Session> SessionTable::create(SessionConfig config, const std::string& owner) {
  const std::string id = random_hex(kIdBytes);
  expire();
  {
    const std::lock_guard lock(mutex_);
    check_count(owner);  // before anything is made: a flood of refusals must be cheap
  }
  admit(id, needed_bytes(config), config, owner);
  try {
    auto session = std::make_shared<Session>(id, random_hex(kTokenBytes), std::move(config),
                                             limits_.credits, scratch_);
    const SessionBytes has = with_frames(*session->config(), session->denoiser_bytes());
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_.at(id);
    settle(entry, has);
    entry.session = session;
    entry.life = SessionLife(clock_());
    return session;
  } catch (...) {
    const std::lock_guard lock(mutex_);
    account_.remove(entries_.at(id).bytes);
    entries_.erase(id);
    throw;
  }
}

/// Called with the mutex held.
void SessionTable::check_bytes(SessionBytes bytes) const {
  if (bytes.own > limits_.max_session_bytes)
    throw RefusedError("the session needs " + mib(bytes.own) + ", but one session may have " +
                           mib(limits_.max_session_bytes),
                       {"max-session-bytes", {}});
  const std::size_t total = account_.total_with(bytes);
  if (total > limits_.max_total_bytes)
    throw RefusedError("with this session all would have " + mib(total) +
                           ", but the server allows " + mib(limits_.max_total_bytes),
                       {"max-total-bytes", limits_.linger});
}

/// Called with the mutex held.
void SessionTable::check_load(double more) const {
  if (limits_.max_load <= 0 || more <= 0) return;
  const auto [there, correction] = loads();
  const double most = limits_.max_load, own = more * correction;
  if (there + own <= most) return;
  throw RefusedError("the session's rate would take " + percent(own) +
                         " of the machine's time; others have " + percent(there) +
                         ", and the server allows " + percent(most),
                     {"max-load", own <= most ? limits_.linger : std::chrono::milliseconds{}});
}

/// Called with the mutex held.
SessionTable::Loads SessionTable::loads() const {
  double measured = 0, expected_of_these = 0, expected_of_others = 0;
  for (const auto& [id, entry] : entries_) {
    const double ms = entry.rate > 0 ? entry.watch->core_ms() : 0;
    measured += 1e-3 * ms * entry.rate;
    (ms > 0 ? expected_of_these : expected_of_others) += entry.load;
  }
  Loads out;
  if (expected_of_these > 0)
    out.correction = std::clamp(measured / expected_of_these, 1 / kMostCorrected, kMostCorrected);
  out.sum = measured + out.correction * expected_of_others;
  return out;
}

/// Called with the mutex held.
void SessionTable::check_count(const std::string& owner) const {
  if (entries_.size() >= limits_.max_sessions)
    throw RefusedError(
        "the server has " + std::to_string(entries_.size()) + " sessions, the most it allows",
        {"max-sessions", limits_.linger});
  const std::size_t most = limits_.max_sessions_per_token;
  if (most == 0 || owner.empty()) return;
  const auto of_owner = [&](const auto& entry) { return entry.second.owner == owner; };
  if (std::count_if(entries_.begin(), entries_.end(), of_owner) >= static_cast<long>(most))
    throw RefusedError("there are " + std::to_string(most) +
                           " sessions with this bearer token, the most the server allows for one",
                       {"max-sessions-per-token", limits_.linger});
}

void SessionTable::admit(const std::string& id, SessionBytes bytes, const SessionConfig& config,
                         const std::string& owner) {
  const std::lock_guard lock(mutex_);
  check_count(owner);
  check_bytes(bytes);
  check_load(config.load);
  const TimePoint now = clock_();
  entries_.emplace(
      id, Entry{nullptr, bytes, 0, config.load, fixed_rate(config), SessionLife(now), owner,
                std::make_shared<SessionRates>(limits_, config.frames_per_second, now),
                std::make_shared<SessionWatch>(++made_)});
  account_.add(bytes);
}

/// Corrects an account; called with the mutex held.
void SessionTable::settle(Entry& entry, SessionBytes bytes) {
  account_.remove(entry.bytes);
  account_.add(bytes);
  entry.bytes = bytes;
}

SessionBytes SessionTable::with_frames(const SessionConfig& session, SessionBytes denoiser) const {
  const std::size_t frames = frame_bytes(session.denoiser, limits_.credits);
  return {denoiser.own + frames + transport_bytes(session), denoiser.scratch};
}

/// Without making anything of that size.
SessionBytes SessionTable::needed_bytes(const SessionConfig& session) const {
  const DenoiserConfig& config = session.denoiser;
  if (std::max(config.width, config.height) > limits_.max_dimension)
    throw InputError("size of a frame",
                     "must be at most " + std::to_string(limits_.max_dimension) +
                         " pixels on each side on this server",
                     std::to_string(config.width) + "x" + std::to_string(config.height));
  return with_frames(session, estimated_denoiser_bytes(config));
}

std::shared_ptr<void> SessionTable::reserve(const std::shared_ptr<Session>& session,
                                            const SessionConfig& config) {
  const SessionBytes bytes = needed_bytes(config);
  {
    const std::lock_guard lock(mutex_);
    Entry& entry = live_entry(session->id());
    check_bytes(bytes);
    check_load(config.load - entry.load);
    account_.add(bytes);
    entry.reserved += bytes.own;
    entry.load = std::max(entry.load, config.load);
    entry.rate = 0;  // what frames took before says nothing of this
  }
  return {session.get(), [this, session, bytes](void*) { end_reservation(*session, bytes); }};
}

void SessionTable::end_reservation(const Session& session, SessionBytes reserved) {
  const std::shared_ptr<const SessionConfig> config = session.config();
  const SessionBytes has = with_frames(*config, session.denoiser_bytes());
  const std::lock_guard lock(mutex_);
  account_.remove(reserved);
  const auto it = entries_.find(session.id());
  if (it == entries_.end() || it->second.session.get() != &session) return;
  it->second.reserved -= reserved.own;
  it->second.load = config->load;
  it->second.rate = fixed_rate(*config);
  settle(it->second, has);
}

SessionTable::Entry& SessionTable::live_entry(const std::string& id) {
  const auto it = entries_.find(id);
  if (it == entries_.end())
    throw RefusedError(Refusal::kUnknownSession, "session " + id + " was deleted");
  return it->second;
}

const SessionTable::Entry& SessionTable::checked(const std::string& id,
                                                 const std::string& token) const {
  const auto it = entries_.find(id);
  if (it == entries_.end() || !it->second.session)
    throw RefusedError(
        Refusal::kUnknownSession,
        "session \"" + id.substr(0, 64) + "\" is unknown: never made, deleted or expired");
  if (!equal_secrets(it->second.session->token(), token))
    throw RefusedError(Refusal::kWrongToken, "the token is not that of session " + id);
  return it->second;
}

std::shared_ptr<Session> SessionTable::find(const std::string& id, const std::string& token) const {
  const std::lock_guard lock(mutex_);
  return checked(id, token).session;
}

SessionTable::Attached SessionTable::attach(const std::string& id, const std::string& token) {
  expire();
  const std::lock_guard lock(mutex_);
  checked(id, token);
  Entry& entry = entries_.at(id);
  const bool taken_over = entry.life.streaming();
  return {entry.session, entry.rates, entry.watch, entry.life.attach(), taken_over};
}

void SessionTable::detach(const Session& session, SessionLife::Hold hold) {
  const std::lock_guard lock(mutex_);
  const auto it = entries_.find(session.id());
  if (it != entries_.end()) it->second.life.detach(hold, clock_());
}

void SessionTable::remove(const std::string& id, const std::string& token) {
  std::shared_ptr<Session> dying;  // freed after the lock: histories are large
  const std::lock_guard lock(mutex_);
  dying = checked(id, token).session;
  account_.remove(entries_.at(id).bytes);
  entries_.erase(id);
}

int SessionTable::expire() {
  std::vector<std::shared_ptr<Session>> dying;
  const TimePoint now = clock_();
  const std::lock_guard lock(mutex_);
  for (auto it = entries_.begin(); it != entries_.end();) {
    Entry& entry = it->second;
    if (entry.session && entry.life.expired(now, limits_.linger)) {
      dying.push_back(std::move(entry.session));
      account_.remove(entry.bytes);
      it = entries_.erase(it);
    } else {
      ++it;
    }
  }
  return static_cast<int>(dying.size());
}

std::vector<SessionTable::Listed> SessionTable::list() const {
  std::vector<Listed> out;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, entry] : entries_)
      if (entry.session)
        out.push_back(
            {entry.session, entry.watch, entry.bytes.own + entry.reserved, entry.life.streaming()});
  }
  std::sort(out.begin(), out.end(), [](const Listed& a, const Listed& b) {
    return a.watch->ordinal() < b.watch->ordinal();
  });
  return out;
}

bool SessionTable::attached(const Session& session) const {
  const std::lock_guard lock(mutex_);
  const auto it = entries_.find(session.id());
  return it != entries_.end() && it->second.life.streaming();
}

std::size_t SessionTable::bytes(const Session& session) const {
  const std::lock_guard lock(mutex_);
  const auto it = entries_.find(session.id());
  return it == entries_.end() ? 0 : it->second.bytes.own + it->second.reserved;
}

std::size_t SessionTable::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

std::size_t SessionTable::session_bytes() const {
  const std::lock_guard lock(mutex_);
  return account_.own();
}

std::size_t SessionTable::scratch_bytes() const {
  const std::lock_guard lock(mutex_);
  return account_.scratch();
}

double SessionTable::load() const {
  const std::lock_guard lock(mutex_);
  return loads().sum;
}

std::size_t SessionTable::total_bytes() const {
  const std::lock_guard lock(mutex_);
  return account_.total();
}

}  // namespace holdfast::server
