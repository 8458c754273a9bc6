#pragma once

#include <memory>

#include "core/denoiser/plan.h"
#include "core/denoiser/stage_timer.h"
#include "core/frame/frame.h"

namespace holdfast {

/// A way to filter whole frames that takes the place of the kernels.
class FrameFilter {
 public:
  virtual ~FrameFilter() = default;
  /// Filters one checked frame into `results`, whose planes are there. `has_past`: history of the
  /// frame before is to be used. Adds repairs, changes and counts to `report`.
  virtual void filter(const Frame& frame, bool has_past, PlaneSet& results, FrameReport& report,
                      StageTimer& timer) = 0;
  /// Held between frames.
  virtual std::size_t bytes() const = 0;
};

/// The one of preset `reference`, in double and pixel by pixel; core/oracle has it. `config` and
/// `plan` must outlive it.
std::unique_ptr<FrameFilter> make_oracle(const DenoiserConfig& config, const Plan& plan);

}  // namespace holdfast
