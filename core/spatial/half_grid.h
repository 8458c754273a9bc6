#pragma once

#include "core/frame/guides.h"

/// Frames at half their resolution: each pixel of a half-size image stands for a quad, the 2x2
/// pixels (2X, 2Y) to (2X + 1, 2Y + 1) of the full image, or for what an odd edge leaves of it. A
/// quad that shows several surfaces is represented by one of them, whole, and never by a mixture.
///
///   reads   guides and planes of the full image      writes  the same at half size
///   halo    the quad                                 state   none
namespace holdfast {

/// Pixels of a half-size image along an edge of `pixels` pixels, which may be odd.
inline int half_size(int pixels) { return (pixels + 1) / 2; }

/// What the quads of a frame stand for.
struct HalfGrid {
  static constexpr int kQuad = 4;          ///< pixels: left to right, then top to bottom
  Channels<float> share;                   ///< kQuad: of each pixel in the mean of its quad; sum 1
  Channels<std::uint32_t> representative;  ///< 0..3: the pixel whose surface it is

  HalfGrid() = default;
  /// For full images of that size.
  HalfGrid(int width, int height, Memory memory = Memory::kOwned)
      : share(half_size(width), half_size(height), kQuad, memory),
        representative(half_size(width), half_size(height), 1, memory) {}
  static void each_image(auto& s, auto&& visit) {
    visit(s.share);
    visit(s.representative);
  }
};

/// Chooses each quad's representative: of the pixels on a surface the one whose surface (same id,
/// normals within 26 degrees, planes within 2 px) most pixels of the quad show; of equals the
/// nearest to the camera, so that what is thin and near survives. Those pixels share the mean in
/// equal parts. A quad without surface is represented by its first pixel, one of a single surface
/// by the first that all others agree with.
void choose_representatives(const Guides& full, HalfGrid& grid);

/// The representatives' guides into `half`, whose view and rays are set by the caller to the full
/// ones' halves (ViewGeometry::halved). Depths are moved along the representative's tangent plane
/// to the middle of the quad, by at most a quarter; motion vectors become half as long.
void halve_guides(const Guides& full, const HalfGrid& grid, Guides& half);

/// Means over the pixels of each quad's surface, of the first `count` channels.
void halve_signal(const Channels<float>& full, int count, const HalfGrid& grid,
                  Channels<float>& half);

/// The same means where each pixel of the quads has an image of its own.
void mean_of_quads(const Channels<float>* const (&pixels)[HalfGrid::kQuad], int count,
                   const HalfGrid& grid, Channels<float>& half);

/// The representatives' values, of any plane.
void halve_plane(const Plane& full, const HalfGrid& grid, Plane& half);

}  // namespace holdfast
