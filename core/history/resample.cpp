#include "core/history/resample.h"

#include <algorithm>
#include <cmath>

#include "core/history/taps.h"
#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

constexpr float kLeastDepthRatio = 0.8f, kGreatestDepthRatio = 1.25f;  // ours
constexpr float kSamplesWithoutMoments = 3.0f;  // SVGF sec. 4.2 takes moments from 4 frames on

/// The pixel of `before` in which the centre of pixel (x, y) of `now` lies.
struct Place {
  int x, y;
};

int scaled(int at, int size, int other) {
  const int place = static_cast<int>((2 * static_cast<std::int64_t>(at) + 1) * other / (2 * size));
  return std::min(place, other - 1);
}

Place place_in(const Guides& before, const Guides& now, int x, int y) {
  return {scaled(x, now.view.width, before.view.width),
          scaled(y, now.view.height, before.view.height)};
}

/// Depth at which the ray of pixel (x, y) meets the tangent plane of the surface at `place`.
float depth_on_plane(const Guides& before, Place place, const Guides& now, int x, int y) {
  const float depth = before.depth().at(place.x, place.y);
  const glm::vec3 normal = before.normal_at(place.x, place.y);
  const PixelRays<float>& rays = now.rays;
  const glm::vec3 lateral = rays.lateral_0 + (static_cast<float>(x) + 0.5f) * rays.lateral_x +
                            (static_cast<float>(y) + 0.5f) * rays.lateral_y;
  const float along = glm::dot(normal, lateral);
  const float distance = glm::dot(normal, before.position_at(place.x, place.y));
  const float met = (distance - rays.near_weight * along) /
                    (rays.far_weight * along + glm::dot(normal, rays.forward));
  return met >= kLeastDepthRatio * depth && met <= kGreatestDepthRatio * depth ? met : depth;
}

void copy(const Channels<float>& from, int count, Channels<float>& to) {
  for_each_row(from.height(), [&](int y) {
    for (int c = 0; c < count; ++c) std::copy_n(from[c].row(y), from.width(), to[c].row(y));
  });
}

/// What `to` keeps and `from` did not, in row y.
void begin_extras(int y, ComponentHistory& to) {
  const int width = to.data.width(), last = to.channels - 1;
  if (to.extras != HistoryExtras::kMoments) return;
  for (int x = 0; x < width; ++x) {
    const float value =
        last == 0 ? to.data[0].at(x, y)
                  : luminance(to.data[0].at(x, y), to.data[1].at(x, y), to.data[2].at(x, y));
    to.moment(1).at(x, y) = value;
    to.moment(2).at(x, y) = value * value;
    to.samples().at(x, y) = std::min(to.samples().at(x, y), kSamplesWithoutMoments);
  }
}

}  // namespace

void resample_guides(const Guides& before, Guides& now) {
  const int width = now.view.width;
  const float scale_x = static_cast<float>(width) / static_cast<float>(before.view.width);
  const float scale_y =
      static_cast<float>(now.view.height) / static_cast<float>(before.view.height);
  for_each_row(now.view.height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Place place = place_in(before, now, x, y);
      const bool surface = before.depth().at(place.x, place.y) > 0.0f;
      now.depth_normal[0].at(x, y) = surface ? depth_on_plane(before, place, now, x, y) : 0.0f;
      for (int axis = 0; axis < 3; ++axis)
        now.depth_normal[1 + axis].at(x, y) = before.normal(axis).at(place.x, place.y);
      now.id[0].at(x, y) = before.id[0].at(place.x, place.y);
      if (now.roughness) now.roughness[0].at(x, y) = before.roughness_at(place.x, place.y);
      if (!now.motion || !before.motion) continue;
      now.motion[0].at(x, y) = scale_x * before.motion[0].at(place.x, place.y);
      now.motion[1].at(x, y) = scale_y * before.motion[1].at(place.x, place.y);
    }
  });
}

void resample_history(const Guides& before, const Guides& now, float share,
                      const ComponentHistory& from, ComponentHistory& to) {
  const bool alike = from.extras == to.extras;
  const int count = alike ? to.data.count() : to.channels + 1;
  const int width = now.view.width;
  const bool same_size = width == before.view.width && now.view.height == before.view.height;
  if (same_size) copy(from.data, count, to.data);
  for_each_row(now.view.height, [&](int y) {
    for (int x = 0; x < width && !same_size; ++x) {
      Taps taps;
      if (now.depth().at(x, y) > 0.0f) {
        const glm::vec3 point = now.position_at(x, y);
        const PixelPoint<float> at = project(glm::mat4(before.view.pixel_from_relative), point);
        taps = find_taps(before, at.x, at.y, {point, now.normal_at(x, y), now.id[0].at(x, y)});
        const Place place = place_in(before, now, x, y);
        if (!taps.any()) taps = identity_taps(before, place.x, place.y);
      }
      for (int c = 0; c < count; ++c) to.data[c].at(x, y) = gather(from.data[c], taps);
      to.samples().at(x, y) *= share;
    }
    if (!alike) begin_extras(y, to);
  });
}

}  // namespace holdfast
