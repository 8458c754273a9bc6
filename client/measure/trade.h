#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace holdfast::measure {

/// One setting of the denoiser on one scene: what it costs and what it leaves wrong.
struct TradePoint {
  std::string recipe;
  std::vector<std::string> presets;  ///< that give this setting; empty = none
  int kernel_taps = 13;              ///< 9, 13 or 25
  int more_levels = 0;               ///< beside those of the recipe
  std::string basis;                 ///< of indirect light, as DenoiserConfig names it; the
                                     ///< preset's is that of recipes that keep cones
  std::vector<std::string> half;     ///< components at half resolution, as DenoiserConfig has them
  std::string history;         ///< its precision, as DenoiserConfig names it; the preset's is that
                               ///< of recipes that keep no moments
  std::string wire = "exact";  ///< profile that its frames and results have been through
  double ms = 0;  ///< processor time of a frame in the core, one thread; median over frames
  struct Stage {
    std::string name;  ///< "frame", or a component's
    double ms = 0;     ///< its share of `ms`
  };
  std::vector<Stage> stages;
  double bytes_per_pixel = 0;          ///< held for history and scratch
  double history_bytes_per_pixel = 0;  ///< of these, kept from frame to frame
  double wire_bytes_per_pixel = 0;     ///< of a frame to the server and its results back, coded
  /// Geometric mean of the RMSE and mean of the SSIM over the filtered components, each judged over
  /// the image and over the effect. A composite would weigh components as the scene's materials
  /// happen to, and an image hides what moves.
  double rmse = 0, ssim = 0;
  double composite_rmse = 0;  ///< of the composite over the image
};

/// A scene with everything that was tried on it.
struct TradeScene {
  std::string name, caption;
  int width = 0, height = 0;  ///< pixels
  std::vector<TradePoint> points;
  /// The presets of the first recipe under the wire profiles that round or compress. Not among
  /// `points`: what they save is no time in the core, so that the front knows nothing of them.
  std::vector<TradePoint> wire_points = {};
  /// How far layers are, under the presets of the first recipe, from those of `reference`, which is
  /// the same method in double precision without any saving: deviation.h.
  struct Deviation {
    std::string preset, layer;
    double typical = 0, largest = 0;
  };
  std::vector<Deviation> deviations = {};
};

/// "reliable fast" of a preset, else what is chosen: "reliable 9 taps irradiance half indirect".
std::string point_name(const TradePoint& point);

/// Indices of the points of a recipe that no other of them beats in both time and RMSE, fastest
/// first. Of points that are equal in both the first is listed.
std::vector<std::size_t> pareto_front(const std::vector<TradePoint>& points,
                                      const std::string& recipe);

/// How much of a point's RMSE is saved by another of its recipe that takes no longer: 0 on the
/// front, 0.1 where another has 10 % less.
double rmse_behind_front(const std::vector<TradePoint>& points, std::size_t point);

/// All scenes as one: of each setting that every scene has, the geometric means of time, both RMSE
/// and bytes held and the means of SSIM and other bytes; time and RMSE are over those of "reliable
/// balanced" on each scene. No points if that one is missing. Deviations: of each layer over the
/// scenes that have it, the root of the mean square of the typical and the greatest of the largest.
TradeScene trade_over_scenes(const std::vector<TradeScene>& scenes);

}  // namespace holdfast::measure
