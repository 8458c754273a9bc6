#pragma once

#include <memory>
#include <vector>

#include "core/denoiser/plan.h"
#include "core/frame/frame.h"
#include "core/history/glossy_history.h"
#include "core/oracle/cones.h"
#include "core/oracle/half_frame.h"
#include "core/oracle/history.h"
#include "core/oracle/statistics.h"

namespace holdfast::oracle {

/// One filtered component and its history.
class ComponentOracle {
 public:
  ComponentOracle(const DenoiserConfig& config, const Plan& plan, const Plan::Entry& entry);

  struct Result {
    Image filtered;
    Image motion, frames, weight;  ///< for the debug planes
    std::uint64_t repaired = 0, repaired_gradients = 0;
    double changed_share = 0;        ///< of the tiles, 0..1
    double mean_history_frames = 0;  ///< over the pixels on surfaces
  };
  /// Local statistics, the effect's vectors, blend with history, spatial filter. `frame` is as the
  /// client sent it.
  Result run(const FrameView& view, const Frame& frame);
  /// The same at half resolution: results are of the frame's size.
  Result run_halved(const HalfFrame& half, const FrameView& full, const Frame& frame);

  const Plan::Entry& entry() const { return entry_; }
  std::size_t bytes() const;

 private:
  struct Input;
  using Samples = std::vector<DirectedSamples>;  ///< of each pixel, or of each one of the quads
  /// The chain of either resolution, but for loading and repair of samples and gradients. `lit`: 1
  /// where the component's light reaches the surface; empty: not known.
  void run_chain(const FrameView& view, const PlaneSet& planes, const FrameKey& key,
                 Samples& samples, const Quads* quads, const Image& lit, const Image* antilag,
                 Result& out);
  Input input_of(const PlaneSet& planes) const;
  Image field_of(const FrameView& view, const Input& input) const;
  bool follows(const FrameView& view) const;
  Past effect_past(const FrameView& view, const Input& input, const Image& field,
                   const Statistics& statistics, const FrameKey& key) const;
  Blended blend(const FrameView& view, const Image& noisy, const Sources& sources,
                const Statistics& statistics) const;
  Image filter(const FrameView& view, const Statistics& statistics);
  Image filter_lit(const FrameView& view, const Image& lit, const Image& noisy,
                   const Statistics& statistics);
  Image lit_of(const FrameView& view, const PlaneSet& planes) const;

  const DenoiserConfig& config_;
  const Plan& plan_;
  Recipe recipe_;
  Plan::Entry entry_;
  bool visibility_;
  History history_;
  std::unique_ptr<Cones> cones_;
};

}  // namespace holdfast::oracle
