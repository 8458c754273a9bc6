#pragma once

#include <vector>

#include "client/measure/image.h"

namespace holdfast::measure {

/// FLIP against one reference: the difference that a viewer sees when flipping between two images,
/// per pixel, in [0,1].
///
/// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020. HDR-FLIP, the
/// largest LDR-FLIP over a range of exposures: Andersson, Nilsson, Shirley, Akenine-Moller 2021.
/// Seen from 0.7 m on a 0.7 m wide screen of 3840 pixels (67 pixels a degree), as both papers have
/// it. The image continues over its border with its outermost pixels; sky is black in both images.
class FlipReference {
 public:
  /// One channel: LDR-FLIP of linear-light grey, clipped to [0,1]. Three channels: HDR-FLIP of
  /// linear radiance, clipped to [0, 65536]. Values are finite. Only `surface` pixels set the
  /// exposures.
  FlipReference(const Image& reference, const Mask& surface);

  /// FLIP of each pixel for a test image of the same size and channels.
  std::vector<float> map(const Image& test) const;

  const std::vector<float>& exposures() const { return exposures_; }

 private:
  /// What LDR-FLIP compares of one image at one exposure.
  struct Percept {
    Image color;                       ///< filtered, Hunt-adjusted L*a*b*; L* alone for grey
    std::vector<float> edges, points;  ///< strength of the features
  };
  Percept percept(const Image& image, float exposure) const;

  Mask surface_;
  std::vector<float> exposures_;
  std::vector<Percept> references_;  ///< by exposure
};

}  // namespace holdfast::measure
