#pragma once

#include "server/calibrated_costs.h"
#include "server/session_config.h"

namespace holdfast::server {

/// Fills in what a session should cost on this machine, where that matters: `preset_ms` of one with
/// a budget, `load` of one that tells its rate, by the fastest preset that it may be given. May
/// measure the presets first.
inline void expect_costs(CalibratedCosts& costs, SessionConfig& session) {
  const bool has_budget = session.budget_ms > 0, tells_rate = session.frames_per_second > 0;
  if (!has_budget && !tells_rate) return;
  std::vector<double> ms = expected_ms(costs.get(), session.denoiser);
  session.load = session.frames_per_second * 1e-3 * (has_budget ? ms.front() : ms.back());
  if (has_budget) session.preset_ms = std::move(ms);
}

}  // namespace holdfast::server
