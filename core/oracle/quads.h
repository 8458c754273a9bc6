#pragma once

#include <span>
#include <vector>

#include "core/oracle/cones.h"
#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// What the quads of a frame stand for at half its resolution: spatial/half_grid.h.
struct Quads {
  static constexpr int kPixels = 4;  ///< of a quad: left to right, then top to bottom
  int width = 0, height = 0;         ///< in quads
  Image share;                       ///< kPixels: of each pixel in the mean of its quad; sum 1
  std::vector<glm::ivec2> shown;     ///< the pixel whose surface represents the quad

  glm::ivec2 representative(int x, int y) const {
    return shown[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};
Quads choose_quads(const Surfaces& full);

/// The representatives, in a view of half the pixels.
Surfaces halved(const Surfaces& full, const Quads& quads);
/// The representatives' values of any plane.
Plane halved(const Plane& full, const Quads& quads);

/// The representatives' values of an image; of an empty one, an empty one.
Image representatives(const Image& full, const Quads& quads);

/// Pixel `k` of each quad, 0 where it is not of the quad's surface.
Image pixel_of_quads(const Image& full, const Quads& quads, int k);
/// Means over the pixels of the quads' surfaces, given an image for each pixel of the quads.
Image mean_of_quads(std::span<const DirectedSamples> pixels, const Quads& quads);

/// spatial/upsample.h: a signal of half size at the frame's own pixels; `beyond` without surface.
Image upsample(const Surfaces& full, const Surfaces& half, const Image& in, const Image& beyond);

}  // namespace holdfast::oracle
