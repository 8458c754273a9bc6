#pragma once

#include <future>
#include <memory>
#include <mutex>

#include "server/calibration.h"
#include "server/scheduler.h"

namespace holdfast::server {

/// The costs of the presets on this machine, measured once by the pool that filters frames.
class CalibratedCosts {
 public:
  explicit CalibratedCosts(Scheduler& scheduler) : scheduler_(scheduler) {}

  /// Measures them at the first call, which takes as long; called from any thread but the pool's.
  const CostTable& get() {
    std::call_once(once_, [this] {
      std::promise<CostTable> measured;
      scheduler_.post(std::make_shared<Strand>(), [&measured] {
        try {
          measured.set_value(calibrate());
        } catch (...) {
          measured.set_exception(std::current_exception());
        }
      });
      table_ = measured.get_future().get();
    });
    return table_;
  }

 private:
  Scheduler& scheduler_;
  std::once_flag once_;
  CostTable table_;
};

}  // namespace holdfast::server
