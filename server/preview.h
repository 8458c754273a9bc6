#pragma once

#include <chrono>
#include <mutex>

#include "core/frame/frame.h"
#include "server/png.h"

namespace holdfast::server {

/// Noisy frame and result side by side, with a line between, at most kPreviewWidth pixels each
/// (every n-th pixel of the frame). The noisy picture is the composite with each filtered signal
/// exchanged for the one that came in:
///
///   noisy = composite + sum over lights(unshadowed (visibility_in - visibility_out))
///           + specular (glossy_in - glossy_out) + albedo (indirect_in - indirect_out)
///
/// Absent specular and albedo count as 1; the noise of a light whose unshadowed plane is not sent
/// is not shown, nor that of values that are not finite. Tone x / (1 + x), then sRGB. `frame` has
/// depth, `results` the composite.
Rgb8 preview(const Frame& frame, const PlaneSet& results);

inline constexpr int kPreviewWidth = 480;

/// The last preview of a session, made only while somebody looks. Every function may be called from
/// any thread.
class PreviewBox {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// True if a picture was asked for lately and the last one is not quite new.
  bool wanted(TimePoint now) const;
  void put(Rgb8 picture, TimePoint now);
  /// The last picture, empty if there is none yet; more are made for some seconds.
  Rgb8 look(TimePoint now);

 private:
  mutable std::mutex mutex_;
  Rgb8 picture_;
  TimePoint looked_ = TimePoint::min(), put_ = TimePoint::min();
};

}  // namespace holdfast::server
