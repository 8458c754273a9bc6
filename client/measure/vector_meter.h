#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "client/measure/comparison_text.h"
#include "client/measure/judged.h"
#include "client/measure/warp.h"

namespace holdfast::measure {

/// Two references of one frame whose noise is independent.
using ReferenceHalves = std::array<Plane, 2>;

/// Two successive frames and the vectors between them.
struct FollowedPair {
  const ReferenceHalves& previous;
  const ReferenceHalves& now;
  const Mask& region;  ///< pixels that may count
  const Mask& effect;  ///< those of them where the effect moves
  /// taps[d][v]: vector v by the samples of draw d. All draws have the same vectors; the first is
  /// the fallback of the others.
  const std::vector<std::vector<Channels<Taps>>>& taps;
};

/// How well one vector brings the previous reference to the current one, as RMSE of judged values.
/// NaN over no pixel.
struct VectorFigures {
  double rmse_valid = 0;     ///< over the pixels where every vector of a draw leads somewhere
  double rmse_fallback = 0;  ///< over those where it or its fallback does
  double rmse_mean = 0;      ///< of the mean of what all draws bring, with fallback
  double share_valid = 0;    ///< of the region's pixels and draws where it leads somewhere
};

struct RegionFigures {
  std::int64_t pixels = 0;    ///< of all pairs
  double reference_rmse = 0;  ///< noise of one half of a reference
  std::vector<VectorFigures> vectors;
};

/// Sums the errors of vectors over pairs of frames. The noise of references cancels: with the error
/// e_h = warp(previous_h) - now_h of each half h, the mean of e_0 e_1 estimates that of the squared
/// error without any noise (0 where chance makes it negative).
class VectorMeter {
 public:
  VectorMeter(Measure measure, std::size_t vectors);
  void add(const FollowedPair& pair);
  RegionFigures figures(Region region) const;

 private:
  struct Mean {
    double sum = 0;
    std::int64_t count = 0;
    void add(const std::vector<double>& values, const Mask& mask, const Mask& also);
    double root() const;
  };
  struct VectorSums {
    Mean valid, fallback, mean, share;
  };
  struct RegionSums {
    Mask mask;  ///< of the current pair
    std::int64_t pixels = 0;
    Mean noise;
    std::vector<VectorSums> vectors;
  };
  void start_pair(const FollowedPair& pair);
  void add_vector(const FollowedPair& pair, std::size_t v, const std::vector<Mask>& all_valid);
  std::vector<double> product_of_errors(const ReferenceHalves& warped,
                                        const ReferenceHalves& now) const;

  Measure measure_;
  std::array<RegionSums, 2> regions_;  ///< by Region
};

/// The mean of both halves.
Plane mean_of(const ReferenceHalves& halves);

/// Where the effect of `now` moves: `effect_mask` of the mean of both halves, each pixel of it the
/// mean of its (2 * radius + 1)^2 neighbours with the same id. Without smoothing, noise above
/// kEffectThreshold would choose the pixels that it makes differ.
Mask moving_effect(const ReferenceHalves& previous, const ReferenceHalves& now,
                   const Plane& previous_ids, const Plane& ids, int radius, const Mask& region);

/// Adds `share` times `from` to `to`, planes of one shape.
void add_share(Plane& to, const Plane& from, float share);

}  // namespace holdfast::measure
