#include "client/check/residual.h"

#include <algorithm>
#include <cmath>

namespace holdfast::check {
namespace {

/// What is linear over a plane in the image: 1 / depth, or depth of an orthographic camera.
double linear(const Seen& frame, int x, int y) {
  const auto depth = static_cast<double>(frame.depth_at(x, y));
  return frame.view.rays.far_weight > 0 ? 1 / depth : depth;
}

bool shows(const Seen& frame, int x, int y, std::uint32_t id) {
  return x >= 0 && y >= 0 && x < frame.width() && y < frame.height() && frame.depth_at(x, y) > 0 &&
         frame.id_at(x, y) == id;
}

/// |second difference| of the linear value at (x, y) along (dx, dy); 0 where a neighbour is
/// missing.
double bend(const Seen& frame, int x, int y, int dx, int dy, std::uint32_t id) {
  if (!shows(frame, x - dx, y - dy, id) || !shows(frame, x + dx, y + dy, id)) return 0;
  return std::abs(linear(frame, x - dx, y - dy) - 2 * linear(frame, x, y) +
                  linear(frame, x + dx, y + dy));
}

/// Ground more uneven than this, relative to depth, says nothing.
constexpr double kUneven = 5e-3;

/// The depth between four pixels of one object.
Sighting between(const Seen& before, int x, int y, glm::dvec2 f, double expected,
                 std::uint32_t id) {
  const double q00 = linear(before, x, y), q10 = linear(before, x + 1, y);
  const double q01 = linear(before, x, y + 1), q11 = linear(before, x + 1, y + 1);
  const double shown =
      (1 - f.y) * ((1 - f.x) * q00 + f.x * q10) + f.y * ((1 - f.x) * q01 + f.x * q11);
  double uneven = std::abs(q00 - q10 - q01 + q11);
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx)
      uneven = std::max(
          {uneven, bend(before, x + dx, y + dy, 1, 0, id), bend(before, x + dx, y + dy, 0, 1, id)});
  // Bilinear interpolation errs by at most 1/8 of the second difference along each axis.
  const double tolerance = uneven / 4 / shown;
  if (tolerance > kUneven) return {};
  const double expected_linear = before.view.rays.far_weight > 0 ? 1 / expected : expected;
  const double difference = std::abs(expected_linear / shown - 1);
  return {Match::kSurface, {}, std::min(std::max(0.0, difference - tolerance), 1.0)};
}

/// The nearest depth of four pixels; 0 if all are sky.
double nearest_depth(const Seen& frame, int x, int y) {
  double nearest = 0;
  for (int k = 0; k < 4; ++k) {
    const auto d = static_cast<double>(frame.depth_at(x + k % 2, y + k / 2));
    if (d > 0 && (nearest == 0 || d < nearest)) nearest = d;
  }
  return nearest;
}

}  // namespace

Sighting look_for(const Seen& before, const glm::dvec3& world_point, std::uint32_t id) {
  Sighting sighting;
  const auto p = project(before.view.pixel_from_relative, world_point - before.view.origin);
  sighting.match = Match::kOutside;
  if (!p.in_front) return sighting;
  sighting.pixel = {p.x, p.y};
  const glm::dvec2 grid = sighting.pixel - 0.5 - before.jitter;
  if (!(grid.x >= 0 && grid.y >= 0 && grid.x < before.width() - 1 && grid.y < before.height() - 1))
    return sighting;
  const int x = static_cast<int>(grid.x), y = static_cast<int>(grid.y);
  int same = 0;
  for (int k = 0; k < 4; ++k) same += shows(before, x + k % 2, y + k / 2, id) ? 1 : 0;
  sighting.match = Match::kUnusable;
  if (same == 4) {
    Sighting found = between(before, x, y, grid - glm::dvec2(x, y), p.depth, id);
    found.pixel = sighting.pixel;
    return found;
  }
  if (same > 0) return sighting;
  const double nearest = nearest_depth(before, x, y);
  sighting.match = nearest > 0 && nearest < p.depth ? Match::kHidden : Match::kNothing;
  return sighting;
}

std::optional<glm::dvec3> normal_from_depth(const Seen& frame, int x, int y) {
  // Far enough apart that depth in half precision still shows the slope.
  constexpr double kSpan = 1.0 / 64;  // rad
  const double angle = std::max(frame.view.pixel_angle, 1e-9);
  const int step = std::max(1, static_cast<int>(std::lround(std::min(kSpan / angle, 1e4))));
  const std::uint32_t id = frame.id_at(x, y);
  const auto along = [&](int dx, int dy) -> std::optional<glm::dvec3> {
    std::optional<glm::dvec3> tangent;
    double least = 0;
    for (const int side : {-1, 1}) {
      const int u = x + side * dx, v = y + side * dy;
      if (!shows(frame, u, v, id)) continue;
      const double change = std::abs(linear(frame, u, v) - linear(frame, x, y));
      if (tangent && change >= least) continue;
      least = change;
      tangent = static_cast<double>(side) * (frame.position(u, v) - frame.position(x, y));
    }
    return tangent;
  };
  const auto right = along(step, 0), down = along(0, step);
  if (!right || !down) return std::nullopt;
  const glm::dvec3 n = glm::cross(*right, *down);
  const double length = glm::length(n);
  if (!(length > 0)) return std::nullopt;
  const glm::dvec3 towards =
      frame.view.rays.far_weight > 0 ? frame.position(x, y) : frame.view.rays.forward;
  return glm::dot(n, towards) > 0 ? -n / length : n / length;
}

double median_residual(std::vector<float> residuals) {
  std::erase_if(residuals, [](float r) { return r < 0; });
  if (residuals.empty()) return 0;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return static_cast<double>(*middle);
}

Comparison compare_residuals(const std::vector<float>& given, const std::vector<float>& other) {
  Comparison result;
  std::vector<float> a, b;
  std::int64_t better = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] >= 0 && other[i] < 0) ++result.lost;
    if (given[i] < 0 || other[i] < 0) continue;
    a.push_back(given[i]);
    b.push_back(other[i]);
    if (other[i] < 0.5f * given[i]) ++better;
  }
  result.samples = static_cast<std::int64_t>(a.size());
  if (a.empty()) return result;
  result.share = static_cast<double>(better) / static_cast<double>(result.samples);
  result.given = median_residual(std::move(a));
  result.other = median_residual(std::move(b));
  return result;
}

}  // namespace holdfast::check
