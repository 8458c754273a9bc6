#include "server/preview.h"

#include <algorithm>
#include <cmath>

#include "core/frame/conventions.h"

namespace holdfast::server {
namespace {

constexpr std::chrono::seconds kWatchedFor{5};     // after the last look
constexpr std::chrono::milliseconds kPeriod{250};  // a preview costs about a millisecond
constexpr int kLine = 2;                           // pixels between the pictures

/// Value of a plane at a pixel; `absent` if there is no such plane. Scalars stand for all channels.
float value_at(const PlaneSet& planes, PlaneId id, int channel, int x, int y, float absent) {
  const Plane* const plane = planes.find(id);
  return plane ? plane->channel(plane->channels() == 1 ? 0 : channel).at(x, y) : absent;
}

/// What exchanging one filtered signal for what came in adds.
float change(const Frame& frame, const PlaneSet& results, PlaneId signal, PlaneId factor,
             float absent, int channel, int x, int y) {
  if (!frame.planes.find(signal) || !results.find(signal)) return 0;
  const float in = value_at(frame.planes, signal, channel, x, y, 0);
  const float out = value_at(results, signal, channel, x, y, 0);
  const float added = value_at(frame.planes, factor, channel, x, y, absent) * (in - out);
  return std::isfinite(added) ? added : 0;
}

float noisy_value(const Frame& frame, const PlaneSet& results, int channel, int x, int y) {
  float sum = results.at({PlaneKind::kComposite, {}}).channel(channel).at(x, y);
  if (!is_surface(frame.planes.at({PlaneKind::kDepth, {}}).channel(0).at(x, y))) return sum;
  const auto add = [&](PlaneId signal, PlaneId factor, float absent) {
    sum += change(frame, results, signal, factor, absent, channel, x, y);
  };
  for (const Plane& plane : frame.planes)
    if (plane.id().kind == PlaneKind::kVisibility)
      add(plane.id(), {PlaneKind::kUnshadowed, plane.id().component}, 0);
  add({PlaneKind::kGlossy, {}}, {PlaneKind::kSpecular, {}}, 1);
  add({PlaneKind::kIndirect, {}}, {PlaneKind::kAlbedo, {}}, 1);
  return sum;
}

/// Linear radiance to an sRGB byte (IEC 61966-2-1), through x / (1 + x).
std::uint8_t shown(float radiance) {
  const float x = std::max(radiance, 0.0f) / (1 + std::max(radiance, 0.0f));
  const float s = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0f, 1.0f)));
}

}  // namespace

Rgb8 preview(const Frame& frame, const PlaneSet& results) {
  const Plane& composite = results.at({PlaneKind::kComposite, {}});
  const int step = (composite.width() + kPreviewWidth - 1) / kPreviewWidth;
  const int width = composite.width() / step, height = std::max(composite.height() / step, 1);
  Rgb8 out{2 * width + kLine, height, {}};
  out.values.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(height) * 3,
                    128);
  const auto pixel = [&](int x, int y) {
    return out.values.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                static_cast<std::size_t>(x)) *
                                   3;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        pixel(x, y)[c] = shown(noisy_value(frame, results, c, x * step, y * step));
        pixel(width + kLine + x, y)[c] = shown(composite.channel(c).at(x * step, y * step));
      }
  return out;
}

bool PreviewBox::wanted(TimePoint now) const {
  const std::lock_guard lock(mutex_);
  const bool watched = looked_ != TimePoint::min() && now - looked_ < kWatchedFor;
  return watched && (put_ == TimePoint::min() || now - put_ >= kPeriod);
}

void PreviewBox::put(Rgb8 picture, TimePoint now) {
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
  put_ = now;
}

Rgb8 PreviewBox::look(TimePoint now) {
  const std::lock_guard lock(mutex_);
  looked_ = now;
  return picture_;
}

}  // namespace holdfast::server
