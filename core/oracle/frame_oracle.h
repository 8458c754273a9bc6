#pragma once

#include <vector>

#include "core/denoiser/frame_filter.h"
#include "core/oracle/component.h"

namespace holdfast::oracle {

/// The whole frame of any recipe and plan; keeps history of its own. What the preset `reference`
/// runs in place of the kernels.
class FrameOracle final : public FrameFilter {
 public:
  /// `config` and `plan` must outlive the oracle.
  FrameOracle(const DenoiserConfig& config, const Plan& plan);

  void filter(const Frame& frame, bool has_past, PlaneSet& results, FrameReport& report,
              StageTimer& timer) override;
  std::size_t bytes() const override;

 private:
  Surfaces load(const Frame& frame, FrameReport& report) const;
  std::vector<Image> filter_components(const FrameView& view, const Frame& frame, PlaneSet& results,
                                       FrameReport& report, StageTimer& timer);
  Image composite(const Surfaces& now, const std::vector<Image>& filtered, const Frame& frame,
                  StageTimer& timer) const;

  const DenoiserConfig& config_;
  const Plan& plan_;
  Scene scene_;
  Surfaces previous_;
  HalfFrame half_;
  std::vector<ComponentOracle> components_;
};

}  // namespace holdfast::oracle
