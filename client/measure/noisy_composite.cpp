#include "client/measure/noisy_composite.h"

#include "core/frame/conventions.h"

namespace holdfast::measure {
namespace {

using Term = ChannelView<const float>;

/// Adds a * b at surfaces; a missing `b` counts as 1.
void add_product(ChannelView<float> out, Term depth, Term a, Term b) {
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      if (is_surface(depth.at(x, y))) out.at(x, y) += a.at(x, y) * (b ? b.at(x, y) : 1.0f);
}

Term channel_or_none(const PlaneSet& planes, PlaneId id, int c) {
  const Plane* plane = planes.find(id);
  return plane ? plane->channel(plane->channels() == 1 ? 0 : c) : Term{};
}

}  // namespace

Plane noisy_composite(const Frame& frame) {
  const PlaneSet& planes = frame.planes;
  const Plane& depth = planes.at({PlaneKind::kDepth, {}});
  Plane out({PlaneKind::kComposite, {}}, depth.width(), depth.height());
  for (int c = 0; c < 3; ++c) {
    if (const Term emission = channel_or_none(planes, {PlaneKind::kEmission, {}}, c))
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.channel(c).at(x, y) = emission.at(x, y);
    const auto add = [&](PlaneId value, PlaneId factor) {
      if (const Term term = channel_or_none(planes, value, c))
        add_product(out.channel(c), depth.channel(0), term, channel_or_none(planes, factor, c));
    };
    for (const Plane& plane : planes)
      if (plane.id().kind == PlaneKind::kUnshadowed)
        add(plane.id(), {PlaneKind::kVisibility, plane.id().component});
    add({PlaneKind::kGlossy, {}}, {PlaneKind::kSpecular, {}});
    add({PlaneKind::kIndirect, {}}, {PlaneKind::kAlbedo, {}});
  }
  return out;
}

}  // namespace holdfast::measure
