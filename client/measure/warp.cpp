#include "client/measure/warp.h"

namespace holdfast::measure {

Warped warp(const Plane& previous, ChannelView<const Taps> taps, ChannelView<const Taps> fallback) {
  const int width = previous.width(), height = previous.height();
  Warped out{Plane(previous.id(), width, height), {}};
  out.found.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool own = taps.at(x, y).any();
      const Taps chosen = own || !fallback ? taps.at(x, y) : fallback.at(x, y);
      out.found.push_back(chosen.any() ? 1 : 0);
      for (int c = 0; c < previous.channels(); ++c)
        out.image.channel(c).at(x, y) = gather(previous.channel(c), chosen);
    }
  return out;
}

}  // namespace holdfast::measure
