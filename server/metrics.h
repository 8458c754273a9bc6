#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <string>

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include "server/frame_slot.h"

namespace holdfast::server {

/// What a server counts, as Prometheus metrics. No label has a value that a client can choose: the
/// number of series is fixed. Every function may be called from any thread.
///
///   holdfast_frames_total{result}         ok, repeated, dropped, invalid, failed
///   holdfast_preset_frames_total{preset}  filtered frames; presets of the core
///   holdfast_stage_seconds{stage}         receive, decode, wait, filter, encode, send: histograms
///   holdfast_received_bytes_total, holdfast_sent_bytes_total  messages of streams
///   holdfast_history_resets_total{reason} first, cut, epoch, failure
///   holdfast_refusals_total{reason}       invalid, unknown_session, wrong_token, taken_over,
///   limit,
///                                         draining, unauthenticated, too_slow, failure
///   holdfast_session_ends_total{reason}   deleted, expired
///   holdfast_sessions, holdfast_streams, holdfast_session_bytes, holdfast_scratch_bytes,
///   holdfast_load (share of the filtering time admitted to sessions that tell their rate),
///   holdfast_resident_bytes, holdfast_ready  at the time of reading
class Metrics {
 public:
  Metrics();

  /// A frame has left the filter.
  void filtered(const FrameSlot& slot);
  /// Its answer has been sent.
  void sent(const FrameSlot& slot, FrameSlot::TimePoint now);
  /// Bytes of one message of a stream.
  void received_bytes(std::size_t bytes) { received_.Increment(static_cast<double>(bytes)); }
  void sent_bytes(std::size_t bytes) { sent_.Increment(static_cast<double>(bytes)); }
  /// A call or stream was refused.
  void refused(std::exception_ptr error);
  void session_ended(const char* reason, int count);

  /// What is measured when the metrics are read.
  struct Now {
    std::size_t sessions = 0, streams = 0, session_bytes = 0, scratch_bytes = 0;
    double load = 0;
    bool ready = false;
  };
  /// All metrics in the text format of Prometheus.
  std::string text(const Now& now);

 private:
  using Counters = prometheus::Family<prometheus::Counter>;
  using Gauges = prometheus::Family<prometheus::Gauge>;

  const std::shared_ptr<prometheus::Registry> registry_;
  Counters &frames_, &presets_, &resets_, &refusals_, &ends_;
  prometheus::Counter &received_, &sent_;
  prometheus::Family<prometheus::Histogram>& stages_;
  prometheus::Histogram &receive_, &decode_, &wait_, &filter_, &encode_, &send_;
  prometheus::Gauge &sessions_, &streams_, &session_bytes_, &scratch_bytes_, &load_,
      &resident_bytes_, &ready_;
};

}  // namespace holdfast::server
