#pragma once

#include <memory>

#include "client/measure/image.h"

namespace holdfast::measure {

/// Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004) against one reference.
///
///   SSIM = (2 mx my + C1)(2 sxy + C2) / ((mx^2 + my^2 + C1)(sx^2 + sy^2 + C2))
///
/// with an 11x11 Gaussian window of sigma 1.5, C1 = 0.01^2, C2 = 0.03^2, values in [0,1], averaged
/// over the channels. Windows hold only pixels that are inside the image and on a surface; their
/// weights are renormalised. (Elsewhere than at borders and beside the sky this is the usual SSIM.)
class SsimReference {
 public:
  /// `reference` holds judged values; `surface` is 1 for the pixels that windows may hold.
  SsimReference(const Image& reference, const Mask& surface);

  /// SSIM of each pixel, mean of the channels, in [-1,1]; 0 where `surface` is 0.
  std::vector<float> map(const Image& test) const;

 private:
  /// Weighted window mean of values[i] * mask.
  std::vector<float> window_mean(const std::vector<float>& values) const;

  Image reference_;
  Mask surface_;
  std::vector<float> inverse_weight_;                      ///< 1 / sum of a window's weights
  std::vector<std::vector<float>> mean_, mean_of_square_;  ///< by channel
};

}  // namespace holdfast::measure
