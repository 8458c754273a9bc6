#include "core/history/taps.h"

#include <cmath>

namespace holdfast {
namespace {

/// Tests previous pixels against one receiver.
class TapTest {
 public:
  TapTest(const Guides& previous, const Receiver& receiver)
      : previous_(previous),
        receiver_(receiver),
        offset_(glm::dot(receiver.normal, receiver.point)),
        tolerance_(tap_tolerance(previous)),
        start_(glm::dot(receiver.normal, previous.rays.lateral_0)),
        across_(glm::dot(receiver.normal, previous.rays.lateral_x)),
        down_(glm::dot(receiver.normal, previous.rays.lateral_y)),
        forward_(glm::dot(receiver.normal, previous.rays.forward)) {}

  bool operator()(int x, int y) const {
    if (x < 0 || y < 0 || x >= previous_.view.width || y >= previous_.view.height) return false;
    const float depth = previous_.depth().at(x, y);
    return depth > 0.0f && previous_.id[0].at(x, y) == receiver_.id && on_plane(x, y);
  }

  /// The same, but for the id.
  bool on_plane(int x, int y) const {
    const float depth = previous_.depth().at(x, y);
    const float lateral =
        start_ + (static_cast<float>(x) + 0.5f) * across_ + (static_cast<float>(y) + 0.5f) * down_;
    const float scale = previous_.rays.near_weight + previous_.rays.far_weight * depth;
    const float distance = scale * lateral + depth * forward_ - offset_;
    return std::abs(distance) <= tolerance_ * scale &&
           glm::dot(receiver_.normal, previous_.normal_at(x, y)) >= kTapNormalCosine;
  }

 private:
  const Guides& previous_;
  const Receiver& receiver_;
  float offset_, tolerance_;
  float start_, across_, down_, forward_;  ///< of PixelRays along the normal
};

/// The corner of the 2x2 block that holds tap column or row `t`, moved inside the image.
int block_start(int t, int size) {
  return t < 0 ? 0 : (t > size - 2 ? (size > 1 ? size - 2 : 0) : t);
}

}  // namespace

Taps identity_taps(const Guides& previous, int x, int y) {
  const int bx = block_start(x, previous.view.width), by = block_start(y, previous.view.height);
  Taps taps;
  taps.offset = static_cast<std::int32_t>(by * previous.depth().stride + bx);
  taps.weight[2 * (y - by) + (x - bx)] = 1.0f;
  return taps;
}

namespace {

/// True for previous pixels on any surface.
struct SurfaceTest {
  const Guides& previous;
  bool operator()(int x, int y) const {
    return x >= 0 && y >= 0 && x < previous.view.width && y < previous.view.height &&
           previous.depth().at(x, y) > 0.0f;
  }
};

/// The valid pixel of the 3x3 neighbourhood that is nearest to (x, y).
template <class Valid>
Taps nearest_taps(const Guides& previous, float x, float y, const Valid& valid) {
  const int nx = static_cast<int>(std::floor(x)), ny = static_cast<int>(std::floor(y));
  float best = 1e9f;
  int best_x = 0, best_y = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const float dx = static_cast<float>(nx + i) - (x - 0.5f);
      const float dy = static_cast<float>(ny + j) - (y - 0.5f);
      const float distance = dx * dx + dy * dy;
      if (distance >= best || !valid(nx + i, ny + j)) continue;
      best = distance;
      best_x = nx + i;
      best_y = ny + j;
    }
  return best < 1e9f ? identity_taps(previous, best_x, best_y) : Taps{};
}

template <class Valid>
Taps bilinear_taps(const Guides& previous, float x, float y, const Valid& valid) {
  const int width = previous.view.width, height = previous.view.height;
  // Beyond one pixel outside, no tap can be inside; also keeps the conversion to int in range.
  if (!(x > -1.0f && y > -1.0f && x < static_cast<float>(width + 1) &&
        y < static_cast<float>(height + 1)))
    return {};
  const float cx = x - 0.5f, cy = y - 0.5f;
  const int ix = static_cast<int>(std::floor(cx)), iy = static_cast<int>(std::floor(cy));
  const float fx = cx - static_cast<float>(ix), fy = cy - static_cast<float>(iy);

  Taps taps;
  const int bx = block_start(ix, width), by = block_start(iy, height);
  taps.offset = static_cast<std::int32_t>(by * previous.depth().stride + bx);
  float sum = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const float w = (i ? fx : 1.0f - fx) * (j ? fy : 1.0f - fy);
      if (w < kLeastTapWeight || !valid(ix + i, iy + j)) continue;
      taps.weight[2 * (iy + j - by) + (ix + i - bx)] += w;
      sum += w;
    }
  if (!(sum > kLeastTapSum)) return nearest_taps(previous, x, y, valid);
  const float inverse = 1.0f / sum;
  for (float& w : taps.weight) w *= inverse;
  const float left = 1.0f - (taps.weight[0] + taps.weight[1] + taps.weight[2] + taps.weight[3]);
  for (float& w : taps.weight) w += w * left;  // a single one is exactly 1
  return taps;
}

}  // namespace

Taps find_taps(const Guides& previous, float x, float y, const Receiver& receiver) {
  return bilinear_taps(previous, x, y, TapTest(previous, receiver));
}

Taps find_similar_taps(const Guides& previous, float x, float y, const Receiver& receiver,
                       std::uint32_t foreign_id) {
  const TapTest test(previous, receiver);
  return bilinear_taps(previous, x, y, [&](int tx, int ty) {
    if (tx < 0 || ty < 0 || tx >= previous.view.width || ty >= previous.view.height) return false;
    const std::uint32_t id = previous.id[0].at(tx, ty);
    return previous.depth().at(tx, ty) > 0.0f && (id != foreign_id || id == receiver.id) &&
           test.on_plane(tx, ty);
  });
}

bool same_surface(const Guides& now, const Guides& previous, int x, int y) {
  bool same = now.id[0].at(x, y) == previous.id[0].at(x, y);
  same &= now.depth().at(x, y) == previous.depth().at(x, y);
  for (int axis = 0; axis < 3; ++axis)
    same &= std::abs(now.normal(axis).at(x, y) - previous.normal(axis).at(x, y)) <=
            previous.normal_error;
  return same;
}

void same_surface_block(const Guides& now, const Guides& previous, int x, int y, int count,
                        std::uint8_t* same) {
  const std::uint32_t* id = now.id[0].row(y) + x;
  const std::uint32_t* id_before = previous.id[0].row(y) + x;
  for (int i = 0; i < count; ++i) same[i] = id[i] == id_before[i] ? 1 : 0;
  for (int c = 0; c < now.depth_normal.count(); ++c) {
    const float* a = now.depth_normal[c].row(y) + x;
    const float* b = previous.depth_normal[c].row(y) + x;
    const float error = c == 0 ? 0.0f : previous.normal_error;
    for (int i = 0; i < count; ++i)
      same[i] &= static_cast<std::uint8_t>(std::abs(a[i] - b[i]) <= error ? 1 : 0);
  }
}

Taps find_taps_on_any_surface(const Guides& previous, float x, float y) {
  return bilinear_taps(previous, x, y, SurfaceTest{previous});
}

Taps rescue_taps(const Guides& previous, float x, float y, const Receiver& receiver) {
  return nearest_taps(previous, x, y, TapTest(previous, receiver));
}

Taps rescue_taps_on_any_surface(const Guides& previous, float x, float y) {
  return nearest_taps(previous, x, y, SurfaceTest{previous});
}

}  // namespace holdfast
