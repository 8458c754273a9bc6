#include "server/metrics.h"

#include <unistd.h>

#include <fstream>

#include <prometheus/text_serializer.h>

#include "core/frame/error.h"
#include "server/error.h"

namespace holdfast::server {
namespace {

/// Seconds: from a small frame in the core to a large one behind a long queue.
prometheus::Histogram::BucketBoundaries buckets() {
  return {0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.033, 0.066, 0.133, 0.266, 0.5, 1, 2, 5};
}

auto& counters(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

auto& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

auto& counter(prometheus::Registry& registry, const char* name, const char* help) {
  return counters(registry, name, help).Add({});
}

double seconds(FrameSlot::TimePoint a, FrameSlot::TimePoint b) {
  return std::chrono::duration<double>(b - a).count();
}

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

const char* name_of(Refusal reason) {
  switch (reason) {
    case Refusal::kUnknownSession: return "unknown_session";
    case Refusal::kWrongToken: return "wrong_token";
    case Refusal::kTakenOver: return "taken_over";
    case Refusal::kLimit: return "limit";
    case Refusal::kDraining: return "draining";
    case Refusal::kUnauthenticated: return "unauthenticated";
    case Refusal::kTooSlow: return "too_slow";
  }
  return "failure";
}

const char* name_of(ResetReason reason) {
  switch (reason) {
    case ResetReason::kNone: break;
    case ResetReason::kFirst: return "first";
    case ResetReason::kCut: return "cut";
    case ResetReason::kEpoch: return "epoch";
    case ResetReason::kFailure: return "failure";
  }
  return "none";
}

}  // namespace

Metrics::Metrics()
    : registry_(std::make_shared<prometheus::Registry>()),
      frames_(counters(*registry_, "holdfast_frames_total", "Frames answered, by result")),
      presets_(counters(*registry_, "holdfast_preset_frames_total",
                        "Filtered frames sent, by the preset that filtered them")),
      resets_(counters(*registry_, "holdfast_history_resets_total",
                       "Frames whose history started anew, by reason")),
      refusals_(counters(*registry_, "holdfast_refusals_total",
                         "Calls and streams that were refused, by reason")),
      ends_(counters(*registry_, "holdfast_session_ends_total", "Sessions that ended, by reason")),
      received_(counter(*registry_, "holdfast_received_bytes_total",
                        "Bytes of the messages that streams brought")),
      sent_(counter(*registry_, "holdfast_sent_bytes_total",
                    "Bytes of the messages that streams took back")),
      stages_(prometheus::BuildHistogram()
                  .Name("holdfast_stage_seconds")
                  .Help("Time of one frame in one stage of the server")
                  .Register(*registry_)),
      receive_(stages_.Add({{"stage", "receive"}}, buckets())),
      decode_(stages_.Add({{"stage", "decode"}}, buckets())),
      wait_(stages_.Add({{"stage", "wait"}}, buckets())),
      filter_(stages_.Add({{"stage", "filter"}}, buckets())),
      encode_(stages_.Add({{"stage", "encode"}}, buckets())),
      send_(stages_.Add({{"stage", "send"}}, buckets())),
      sessions_(gauge(*registry_, "holdfast_sessions", "Sessions that exist")),
      streams_(gauge(*registry_, "holdfast_streams", "Open streams")),
      session_bytes_(gauge(*registry_, "holdfast_session_bytes", "Memory accounted to sessions")),
      scratch_bytes_(gauge(*registry_, "holdfast_scratch_bytes",
                           "Memory accounted to the scratch that sessions share")),
      load_(gauge(*registry_, "holdfast_load",
                  "Share of the filtering time admitted to sessions that tell their rate")),
      resident_bytes_(gauge(*registry_, "holdfast_resident_bytes", "Memory of the process")),
      ready_(gauge(*registry_, "holdfast_ready", "1 if new sessions are accepted")) {
  // Series exist from the start, so that a rate over them does not miss the first event.
  for (const char* result : {"ok", "repeated", "dropped", "invalid", "failed"})
    frames_.Add({{"result", result}});
  for (const std::string& preset : preset_names()) presets_.Add({{"preset", preset}});
  for (const char* reason : {"first", "cut", "epoch", "failure"}) resets_.Add({{"reason", reason}});
  for (const char* reason : {"invalid", "unknown_session", "wrong_token", "taken_over", "limit",
                             "draining", "unauthenticated", "too_slow", "failure"})
    refusals_.Add({{"reason", reason}});
  for (const char* reason : {"deleted", "expired"}) ends_.Add({{"reason", reason}});
}

void Metrics::filtered(const FrameSlot& slot) {
  receive_.Observe(seconds(slot.begun, slot.ended));
  decode_.Observe(std::chrono::duration<double>(slot.decode).count());
  wait_.Observe(seconds(slot.ended, slot.started));
  if (slot.error) {
    const bool invalid = slot.error->code() == v1::FRAME_ERROR_CODE_INVALID_FRAME;
    frames_.Add({{"result", invalid ? "invalid" : "failed"}}).Increment();
    return;
  }
  const bool dropped = slot.answer->dropped;
  frames_.Add({{"result", slot.repeated ? "repeated" : dropped ? "dropped" : "ok"}}).Increment();
  if (slot.repeated || dropped) return;
  presets_.Add({{"preset", slot.answer->report.preset}}).Increment();
  filter_.Observe(slot.answer->report.ms / 1000);
  if (slot.answer->reset != ResetReason::kNone)
    resets_.Add({{"reason", name_of(slot.answer->reset)}}).Increment();
}

void Metrics::sent(const FrameSlot& slot, FrameSlot::TimePoint now) {
  encode_.Observe(std::chrono::duration<double>(slot.encode).count());
  send_.Observe(seconds(slot.answered, now));
}

void Metrics::refused(std::exception_ptr error) {
  const char* reason = "failure";
  try {
    std::rethrow_exception(std::move(error));
  } catch (const InputError&) {
    reason = "invalid";
  } catch (const RefusedError& refusal) {
    reason = name_of(refusal.reason());
  } catch (...) {  // keeps the reason "failure"
  }
  refusals_.Add({{"reason", reason}}).Increment();
}

void Metrics::session_ended(const char* reason, int count) {
  ends_.Add({{"reason", reason}}).Increment(count);
}

std::string Metrics::text(const Now& now) {
  sessions_.Set(static_cast<double>(now.sessions));
  streams_.Set(static_cast<double>(now.streams));
  session_bytes_.Set(static_cast<double>(now.session_bytes));
  scratch_bytes_.Set(static_cast<double>(now.scratch_bytes));
  load_.Set(now.load);
  resident_bytes_.Set(resident_bytes());
  ready_.Set(now.ready ? 1 : 0);
  return prometheus::TextSerializer().Serialize(registry_->Collect());
}

}  // namespace holdfast::server
