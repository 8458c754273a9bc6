#pragma once

#include <cstdint>
#include <vector>

#include "core/frame/guides.h"
#include "core/spatial/half_grid.h"

namespace holdfast {

/// Joint bilateral upsampling (Kopf et al. 2007): brings signals filtered at half size to a frame's
/// own pixels. Pixel p of the full image takes the mean of the 2x2 nearest half pixels q, of which
/// each counts
///   g(q) = b(q) [id_p = id_q] exp(-(|plane distance| / (2 px) + normal_power (1 - n_p . n_q)))
/// b(q) being the bilinear weight (9, 3, 3, 1 sixteenths), the plane distance that of q's surface
/// point from p's tangent plane, px the width of a pixel at p's depth; normal_power is that of
/// FilterWeights. Where the sum of g is below kLeastWeight, the most similar of the 5x5 nearest
/// half pixels stands in: that of the same id first, then that of the largest g with a Gaussian of
/// one half pixel for b. p's own quad is among them and shows a surface, if p does.
///
/// The weights of a frame are found once for all of its signals, and kept in 16 bits each: a mean
/// is off by 1e-5 of the differences at most.
class Upsampling {
 public:
  static constexpr float kLeastWeight = 1e-3f;  ///< of the 2x2 nearest half pixels; ours

  Upsampling() = default;
  /// For full images of that size.
  Upsampling(int width, int height, Memory memory = Memory::kOwned);
  static void each_image(auto& u, auto&& visit) { visit(u.words_); }

  /// Finds the weights of a frame, in parallel.
  ///   reads guides of both sizes | writes the weights | halo 2 half pixels
  void find(const Guides& full, const Guides& half);

  /// Up to three channels of a signal.
  struct Signal {
    int channels = 0;
    ChannelView<const float> in[3];      ///< of half size
    ChannelView<const float> beyond[3];  ///< of full size: what pixels without surface show
    ChannelView<float> out[3];           ///< of full size
  };
  /// Brings a signal to the full size by the weights found last, in parallel.
  ///   reads weights, `in`, `beyond` | writes `out` | halo 2 half pixels
  void run(const Signal& signal) const;

 private:
  int width_ = 0;
  Channels<std::uint32_t> words_;     ///< see upsample.cpp
  std::vector<std::uint8_t> blocks_;  ///< likewise
};

}  // namespace holdfast
