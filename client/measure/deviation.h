#pragma once

#include <cstdint>

#include "client/measure/image.h"
#include "core/frame/plane.h"

namespace holdfast::measure {

/// How far one layer of a result lies from that of another result, over frames: the differences of
/// judged values (judged.h), which are in 0..1.
class DeviationMeter {
 public:
  /// Adds a frame. Both planes are of one kind and size; of `surface`, 1 = counts.
  void add(const Plane& result, const Plane& wanted, const Mask& surface);

  /// Root of the mean square over pixels, channels and frames; NaN without any.
  double typical() const;
  /// Of a value of a pixel; 0 without any.
  double largest() const { return largest_; }

 private:
  double squares_ = 0, largest_ = 0;
  std::int64_t values_ = 0;
};

}  // namespace holdfast::measure
