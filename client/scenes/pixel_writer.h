#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "core/frame/plane.h"

namespace holdfast::scenes {

/// Writes pixels of one float plane; a default one ignores what it is given.
class PixelWriter {
 public:
  PixelWriter() = default;
  /// Adds the plane to `planes`, which must outlive the writer.
  PixelWriter(PlaneSet& planes, PlaneId id, int width, int height) {
    Plane& plane = planes.add(id, width, height);
    for (int c = 0; c < plane.channels(); ++c)
      channels_[static_cast<std::size_t>(c)] = plane.channel(c);
  }

  explicit operator bool() const { return static_cast<bool>(channels_[0]); }

  void set(int x, int y, double value) const { write(0, x, y, value); }
  void set(int x, int y, const glm::dvec2& value) const {
    for (int c = 0; c < 2; ++c) write(static_cast<std::size_t>(c), x, y, value[c]);
  }
  void set(int x, int y, const glm::dvec3& value) const {
    for (int c = 0; c < 3; ++c) write(static_cast<std::size_t>(c), x, y, value[c]);
  }

 private:
  void write(std::size_t c, int x, int y, double value) const {
    if (channels_[c]) channels_[c].at(x, y) = static_cast<float>(value);
  }
  std::array<ChannelView<float>, 3> channels_;
};

/// The same for a plane of ids.
class IdWriter {
 public:
  IdWriter() = default;
  IdWriter(PlaneSet& planes, PlaneId id, int width, int height)
      : ids_(planes.add(id, width, height).ids()) {}

  void set(int x, int y, std::uint32_t id) const {
    if (ids_) ids_.at(x, y) = id;
  }

 private:
  ChannelView<std::uint32_t> ids_;
};

}  // namespace holdfast::scenes
