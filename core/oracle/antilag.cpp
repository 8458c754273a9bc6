#include "core/oracle/antilag.h"

#include <algorithm>
#include <cmath>

#include "core/frame/plane_size.h"
#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

constexpr double kLargest = double{1e15f};
constexpr double kLeastValid = 1e-3;  // share of samples nearby, below which lambda fades

/// The surfaces of the strata's middle pixels, as a camera of a third of the resolution sees them.
Surfaces strata_of(const Surfaces& now, int width, int height) {
  Surfaces strata;
  strata.width = width;
  strata.height = height;
  strata.view = now.view;
  strata.view.pixel_angle *= kStratum;
  strata.view.rays.lateral_x *= double{kStratum};
  strata.view.rays.lateral_y *= double{kStratum};
  strata.depth = Image(width, height, 1);
  strata.normal = Image(width, height, 3);
  for_each_pixel(width, height, [&](int x, int y) {
    const int middle_x = std::min(kStratum * x + kStratum / 2, now.width - 1);
    const int middle_y = std::min(kStratum * y + kStratum / 2, now.height - 1);
    strata.depth.at(x, y) = now.depth.at(middle_x, middle_y);
    for (int c = 0; c < 3; ++c) strata.normal.at(x, y, c) = now.normal.at(middle_x, middle_y, c);
  });
  return strata;
}

/// now - then, the larger of both, and 1; 0 where that is no sample.
Image samples_of(const Plane& plane, std::uint64_t& repaired) {
  Image out(plane.width(), plane.height(), 3);
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    const double now = double{plane.channel(0).at(x, y)}, then = double{plane.channel(1).at(x, y)};
    bool usable = true;
    for (const double v : {now, then}) {
      usable &= v >= 0 && std::isfinite(v);
      repaired += v >= 0 && v <= kLargest ? 0 : 1;
    }
    if (!usable) return;
    out.at(x, y, 0) = std::min(now, kLargest) - std::min(then, kLargest);
    out.at(x, y, 1) = std::min(std::max(now, then), kLargest);
    out.at(x, y, 2) = out.at(x, y, 1) > 0 ? 1 : 0;
  });
  return out;
}

}  // namespace

Image antilag_of(const Surfaces& now, const Plane& gradients, int levels, std::uint64_t& repaired) {
  Image samples = samples_of(gradients, repaired);
  const Surfaces strata = strata_of(now, samples.width(), samples.height());
  const Image ones(samples.width(), samples.height(), 1, 1.0);
  for (int level = 0; level < levels; ++level)
    samples = filter_pass(strata, samples, ones, box_pass(1 << level)).values;
  Image out(samples.width(), samples.height(), 1);
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    const double delta = std::abs(samples.at(x, y, 0)), largest = samples.at(x, y, 1);
    const double known = std::min(samples.at(x, y, 2) / kLeastValid, 1.0);
    out.at(x, y) = largest > 0 ? known * std::min(delta / largest, 1.0) : 0.0;
  });
  return out;
}

}  // namespace holdfast::oracle
