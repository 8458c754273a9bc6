#pragma once

#include <cmath>
#include <vector>

#include "core/spatial/guided_filter.h"

namespace holdfast::test {

/// Filtered signals and spread of one pixel.
struct OraclePixel {
  double values[kMaxFilterChannels];
  double spread;
};

/// The documented formula of FilterWeights and Spread, pixel by pixel and tap by tap, in double and
/// from the camera's own matrices: slow and plain, kept for ever.
class FilterOracle {
 public:
  FilterOracle(const FilterPass& pass, const Camera& camera)
      : pass_(pass),
        width_(pass.guides->view.width),
        height_(pass.guides->view.height),
        camera_(camera),
        world_from_clip_(glm::inverse(camera.clip_from_view * camera.view_from_world)) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) points_.push_back(point(x + 0.5, y + 0.5, depth(x, y)));
  }

  OraclePixel at(int px, int py) const {
    OraclePixel out{};
    for (int c = 0; c < pass_.channels; ++c) out.values[c] = pass_.in[c].at(px, py);
    const bool has_spread = pass_.spread != Spread::kNone;
    if (has_spread) out.spread = pass_.spread_in.at(px, py);
    if (!(depth(px, py) > 0)) return out;
    double sums[kMaxFilterChannels] = {}, weights = 0, spreads = 0;
    for (int ky = -pass_.weights.radius; ky <= pass_.weights.radius; ++ky)
      for (int kx = -pass_.weights.radius; kx <= pass_.weights.radius; ++kx) {
        if (pass_.weights.diamond && std::abs(kx) + std::abs(ky) > pass_.weights.radius) continue;
        const int qx = px + kx * pass_.step, qy = py + ky * pass_.step;
        if (qx < 0 || qy < 0 || qx >= width_ || qy >= height_ || !(depth(qx, qy) > 0)) continue;
        const double h =
            double(pass_.weights.kernel[std::abs(kx)]) * double(pass_.weights.kernel[std::abs(ky)]);
        const double g = h * std::exp(-exponent(px, py, qx, qy));
        const double spread = has_spread ? double{pass_.spread_in.at(qx, qy)} : 0.0;
        const bool by_samples = pass_.spread == Spread::kSamples;
        const double weight = by_samples ? g * spread : g;
        for (int c = 0; c < pass_.channels; ++c) sums[c] += weight * double(pass_.in[c].at(qx, qy));
        weights += weight;
        spreads += g * g * spread;
      }
    for (int c = 0; c < pass_.channels; ++c) out.values[c] = sums[c] / weights;
    out.spread = pass_.spread == Spread::kSamples ? weights * weights / spreads
                                                  : spreads / (weights * weights);
    return out;
  }

 private:
  double depth(int x, int y) const { return pass_.guides->depth().at(x, y); }

  /// World position at a planar depth, on the segment between the near and the far plane.
  glm::dvec3 point(double px, double py, double planar_depth) const {
    const double nx = 2 * px / width_ - 1, ny = 1 - 2 * py / height_;
    glm::dvec4 near = world_from_clip_ * glm::dvec4(nx, ny, -1, 1);
    glm::dvec4 far = world_from_clip_ * glm::dvec4(nx, ny, 1, 1);
    near /= near.w;
    far /= far.w;
    const double near_depth = -(camera_.view_from_world * near).z;
    const double far_depth = -(camera_.view_from_world * far).z;
    const double t = (planar_depth - near_depth) / (far_depth - near_depth);
    return glm::dvec3(near) + t * glm::dvec3(far - near);
  }

  double exponent(int px, int py, int qx, int qy) const {
    const auto normal = [&](int x, int y) { return glm::dvec3(pass_.guides->normal_at(x, y)); };
    const auto surface = [&](int x, int y) {
      return points_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(x)];
    };
    const double d = depth(px, py);
    const glm::dvec3 corner = point(0, 0, d);
    const double footprint =
        std::sqrt(glm::distance(point(1, 0, d), corner) * glm::distance(point(0, 1, d), corner));
    const double distance = std::abs(glm::dot(surface(qx, qy) - surface(px, py), normal(px, py)));
    double sum = distance / (double(pass_.weights.plane_sigma_px) * pass_.step * footprint);
    sum += double(pass_.weights.normal_power) *
           std::max(0.0, 1 - glm::dot(normal(px, py), normal(qx, qy)));
    if (pass_.luminance)
      sum += std::abs(double(pass_.luminance.at(px, py)) - double(pass_.luminance.at(qx, qy))) *
             double(pass_.inverse_luminance_sigma.at(px, py));
    if (pass_.footprint[0]) {
      const double dx = qx - px, dy = qy - py;
      sum += double(pass_.footprint[0].at(px, py)) * dx * dx +
             2 * double(pass_.footprint[1].at(px, py)) * dx * dy +
             double(pass_.footprint[2].at(px, py)) * dy * dy;
    }
    return sum;
  }

  const FilterPass& pass_;
  int width_, height_;
  Camera camera_;
  glm::dmat4 world_from_clip_;
  std::vector<glm::dvec3> points_;
};

}  // namespace holdfast::test
