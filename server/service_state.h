#pragma once

#include <atomic>
#include <memory>

#include <spdlog/logger.h>

#include "server/config.h"
#include "server/scheduler.h"
#include "server/session_table.h"
#include "server/stream_registry.h"

namespace holdfast::server {

/// What all calls share. Outlives every call.
struct ServiceState {
  ServiceState(const ServerConfig& c, std::shared_ptr<spdlog::logger> l)
      : config(c), log(std::move(l)), sessions(c.limits), scheduler(c.threads) {}

  const ServerConfig config;
  const std::shared_ptr<spdlog::logger> log;
  SessionTable sessions;
  StreamRegistry streams;
  Scheduler scheduler;
  std::atomic<bool> draining{false};
};

}  // namespace holdfast::server
