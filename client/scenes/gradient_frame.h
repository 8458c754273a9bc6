#pragma once

#include <vector>

#include "client/scenes/noise.h"
#include "client/scenes/view.h"
#include "core/frame/plane.h"
#include "core/frame/plane_size.h"

namespace holdfast::scenes {

/// Gradient samples of one frame, for A-SVGF: of one random pixel in each stratum of 3x3, the
/// luminance of its first sample of each component, and of the same sample (same surface point,
/// same random numbers) shaded in the world of the frame before. `render_noisy` records the first;
/// `finish` shades the second once the world has been set back.
class GradientSamples {
 public:
  /// Chooses the pixels.
  explicit GradientSamples(const View& now);

  bool is_chosen(int x, int y) const {
    const Sample& sample = at(x, y);
    return sample.x == x && sample.y == y;
  }
  /// What a chosen pixel shows. Pixels of sky are not recorded: their samples are (0, 0).
  void record_surface(int x, int y, const Primary& primary);
  /// Luminance of the component of a `Stream` at a chosen pixel.
  void record_now(int x, int y, std::uint64_t stream, double luminance) {
    at(x, y).now[stream] = luminance;
  }

  /// Carries each recorded surface to where it was, shades it there, and adds the gradient planes
  /// to `out`. `then`: the frame before at its time, with the frame number of `now`, from which the
  /// random numbers follow. `now_frame`, `then_frame`: both times in frames. Objects that were not
  /// there yet give (0, 0).
  void finish(const View& then, double now_frame, double then_frame, PlaneSet& out) const;

 private:
  struct Sample {
    int x = 0, y = 0;
    bool is_surface = false;
    std::size_t object = 0;
    Surface surface;
    std::vector<double> now;  ///< by stream
  };
  Sample& at(int x, int y) { return samples_[index(x, y)]; }
  const Sample& at(int x, int y) const { return samples_[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y / kStratum) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x / kStratum);
  }

  PlaneSize size_;
  std::vector<Sample> samples_;
};

/// Adds the gradient planes of the scene's components, all (0, 0): no sample says that nothing is
/// known to change. For frames without a frame before, and where nothing moves.
void add_empty_gradients(const View& view, PlaneSet& out);

}  // namespace holdfast::scenes
