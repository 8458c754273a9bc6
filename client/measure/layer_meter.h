#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "client/measure/flip.h"
#include "client/measure/judged.h"
#include "client/measure/ssim.h"

namespace holdfast::measure {

/// Errors of one layer over a sequence, on one mask. A number without any judged pixel is NaN.
struct LayerErrors {
  double rmse = 0;     ///< root of the mean squared error over pixels, channels and frames
  double psnr = 0;     ///< dB for a peak of 1: -20 log10(rmse); +inf for rmse = 0
  double ssim = 0;     ///< mean SSIM
  double flip = 0;     ///< mean FLIP; NaN if not asked for
  double flicker = 0;  ///< RMSE of the change between consecutive frames against the reference's
  std::int64_t non_finite = 0;     ///< values of the result that are not finite, sky included
  std::int64_t judged_pixels = 0;  ///< over all frames
  struct Frame {
    std::int64_t frame = 0;
    double rmse = 0;
  };
  std::vector<Frame> per_frame;  ///< frames with at least one judged pixel
};

/// One layer of one reference frame, ready to be compared with several results.
struct ReferenceLayer {
  std::int64_t frame = 0;
  Measure measure = Measure::kClip;
  Image judged;
  Mask surface;                   ///< judged over the whole image
  Mask effect;                    ///< judged for the effect; all 0 without an earlier reference
  bool follows_previous = false;  ///< the frame before has a reference, too
  Image change;                   ///< judged minus the one before; only if follows_previous
  Mask change_surface;            ///< surface in both frames; only if follows_previous
  std::unique_ptr<SsimReference> ssim;
  std::unique_ptr<FlipReference> flip;  ///< null if not asked for
};

/// Makes the reference layers of consecutive reference frames.
class ReferenceTrack {
 public:
  ReferenceTrack(Measure measure, bool with_flip) : measure_(measure), with_flip_(with_flip) {}
  /// `position` counts the sequence's frames, so that gaps between references are seen.
  ReferenceLayer next(std::int64_t frame, std::size_t position, const Image& clean,
                      const Mask& surface);

 private:
  Measure measure_;
  bool with_flip_;
  Image earlier_;  ///< judged values of the nearest earlier reference
  Mask earlier_surface_;
  std::size_t earlier_position_ = 0;
};

/// Sums the errors of one layer of one result, over the image and over the effect at once.
class LayerMeter {
 public:
  /// Adds a frame; frames come in order. `result` has the reference's size and channels.
  void add(const ReferenceLayer& reference, const Plane& result);

  LayerErrors image() const { return image_.errors(non_finite_); }
  LayerErrors effect() const { return effect_.errors(non_finite_); }

 private:
  struct Mean {
    double sum = 0;
    std::int64_t count = 0;
    double value() const;
  };
  struct Sums {
    Mean squared, ssim, flip, flicker;
    std::int64_t pixels = 0;
    std::vector<LayerErrors::Frame> per_frame;
    LayerErrors errors(std::int64_t non_finite) const;
  };
  /// Per-pixel errors of the current frame.
  struct Maps {
    std::vector<double> squared, flicker;  ///< summed over channels
    std::vector<float> ssim, flip;
  };
  static void accumulate(Sums& sums, const Mask& mask, const ReferenceLayer& reference,
                         const Maps& maps);

  Image previous_;  ///< judged values of the result before
  std::int64_t non_finite_ = 0;
  Sums image_, effect_;
};

/// Sum over the channels of (a - b)^2, for each pixel.
std::vector<double> squared_difference(const Image& a, const Image& b);

/// a - b.
Image difference(const Image& a, const Image& b);

}  // namespace holdfast::measure
