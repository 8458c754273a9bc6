#pragma once

#include <algorithm>
#include <atomic>
#include <memory>

#include <spdlog/logger.h>

#include "server/calibrated_costs.h"
#include "server/config.h"
#include "server/job_threads.h"
#include "server/metrics.h"
#include "server/scheduler.h"
#include "server/session_table.h"
#include "server/shared_memory_offers.h"
#include "server/stream_registry.h"
#include "server/token_file.h"

namespace holdfast::server {

/// What all calls share. Outlives every call.
struct ServiceState {
  ServiceState(const ServerConfig& c, std::shared_ptr<spdlog::logger> l)
      : config(c),
        log(std::move(l)),
        tokens(c.token_file),
        sessions(c.limits, std::chrono::steady_clock::now, Scheduler::frames_at_once(c.threads)),
        shared_memory(sessions),
        streams(c.max_streams, c.max_waiting_per_address),
        scheduler(c.threads),
        encoders(std::max(1, scheduler.threads() / 4)),
        costs(scheduler) {
    if (c.calibrate) costs.get();
  }

  const ServerConfig config;
  const std::shared_ptr<spdlog::logger> log;
  Metrics metrics;
  TokenFile tokens;
  SessionTable sessions;
  SharedMemoryOffers shared_memory;
  StreamRegistry streams;
  Scheduler scheduler;
  /// Encode results with formats and codecs, as many as lead in the scheduler. A job is one piece
  /// of at most 1 MiB, about 1 to 3 ms; a stream has one at a time, so that streams take turns.
  JobThreads encoders;
  /// Makes and deletes sessions: their memory is all written, or given back, once, which takes up
  /// to some tenths of a second.
  JobThreads session_jobs{2};
  CalibratedCosts costs;
  std::atomic<bool> draining{false};
  const std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
};

}  // namespace holdfast::server
