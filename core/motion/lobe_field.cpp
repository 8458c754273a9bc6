#include "core/motion/lobe_field.h"

#include <algorithm>

#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"
#include "core/motion/lobe_spread.h"

namespace holdfast {
namespace {

// Variance of the filter's footprint, in terms of the lobe's and of pixels: wider costs sharpness,
// narrower leaves noise. Ours, tuned on glossy-floor.
constexpr float kLobeVariance = 0.5f;
constexpr float kPixelVariance = 2.5f;  // px^2

/// The lobes of a block of pixels.
struct LobeBlock {
  const BlockPixels& pixels;
  const glm::mat4& pixel;
  float focal_px;
  const float *roughness, *direction[3], *hit_m;  ///< of the pixels
  float* out[kEffectFieldChannels];
};

HOLDFAST_INLINE void measure_block_body(const LobeBlock& a) {
  const BlockPixels pixels = a.pixels;
  const Projection now = projection_of(a.pixel);
  const float *depth = pixels.depth, *nx = pixels.normal[0], *ny = pixels.normal[1],
              *nz = pixels.normal[2];
  const float *dx = a.direction[0], *dy = a.direction[1], *dz = a.direction[2];
  const float *hit_m = a.hit_m, *roughness = a.roughness;
  float *valid = a.out[kFieldValid], *ratio = a.out[kFieldRatio], *xx = a.out[kFieldPrecision],
        *xy = a.out[kFieldPrecision + 1], *yy = a.out[kFieldPrecision + 2];
  const float focal_px = a.focal_px;
#pragma GCC ivdep
  for (int i = 0; i < pixels.count; ++i) {
    const float aimed = (dx[i] != 0.0f ? 1.0f : 0.0f) + (dy[i] != 0.0f ? 1.0f : 0.0f) +
                        (dz[i] != 0.0f ? 1.0f : 0.0f);
    const float placed = (hit_m[i] >= 0.0f ? 1.0f : 0.0f) * (depth[i] > 0.0f ? 1.0f : 0.0f);
    const float known = aimed * placed > 0.0f ? 1.0f : 0.0f;
    const Float3 s = position(pixels, depth, i), n{nx[i], ny[i], nz[i]};
    const LobeSpread lobe = lobe_spread(now, focal_px, s, n, hit_m[i], roughness[i]);
    // `precision_of_covariance` of effect_field.h.
    const float in = kLobeVariance * lobe.in_plane * lobe.in_plane;
    const float across = kLobeVariance * lobe.out_of_plane * lobe.out_of_plane;
    const float vxx =
        kPixelVariance + in * lobe.along_x * lobe.along_x + across * lobe.along_y * lobe.along_y;
    const float vxy = (in - across) * lobe.along_x * lobe.along_y;
    const float vyy =
        kPixelVariance + in * lobe.along_y * lobe.along_y + across * lobe.along_x * lobe.along_x;
    const float half = 0.5f / max_of(vxx * vyy - vxy * vxy, 1e-12f);
    valid[i] = known;
    ratio[i] = 0.0f;
    xx[i] = known > 0.0f ? vyy * half : 0.0f;
    xy[i] = known > 0.0f ? -vxy * half : 0.0f;
    yy[i] = known > 0.0f ? vxx * half : 0.0f;
  }
}

HOLDFAST_KERNEL(measure_block, LobeBlock)

/// Most of an image may have no reflections at all.
bool any_sample(const LobeBlock& block) {
  return std::any_of(block.direction, block.direction + 3, [&](const float* direction) {
    return std::any_of(direction, direction + block.pixels.count,
                       [](float d) { return d != 0.0f; });
  });
}

}  // namespace

void measure_lobes(const Guides& now, const GlossyPlanes& planes, Channels<float>& out, int first) {
  const glm::mat4 pixel(now.view.pixel_from_relative);
  const float focal_px = 1.0f / static_cast<float>(now.view.pixel_angle);
  for_each_row(now.view.height, [&](int y) {
    static constexpr float kMirror[kFollowBlock] = {};
    for (int x = 0; x < now.view.width; x += kFollowBlock) {
      const BlockPixels pixels(now, x, y, std::min(kFollowBlock, now.view.width - x));
      LobeBlock block{pixels,   pixel,
                      focal_px, now.roughness ? now.roughness[0].row(y) + x : kMirror,
                      {},       planes.distance->channel(0).row(y) + x,
                      {}};
      for (int axis = 0; axis < 3; ++axis)
        block.direction[axis] = planes.direction->channel(axis).row(y) + x;
      for (int c = 0; c < kEffectFieldChannels; ++c) block.out[c] = out[first + c].row(y) + x;
      if (any_sample(block))
        measure_block(block);
      else
        for (float* channel : block.out) std::fill_n(channel, pixels.count, 0.0f);
    }
  });
}

}  // namespace holdfast
