#include "core/shading/fit/fit_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shading/fit/nelder_mead.h"

namespace holdfast::fit {
namespace {

/// A transformed cosine, as a density over the directions above the horizon.
class TransformedCosine {
 public:
  TransformedCosine(const Parameters& p, const LobeSamples& lobe) {
    const double c = lobe.v.z, s = lobe.v.x;
    const glm::dmat3 tangent_from_mirror(c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c);
    const glm::dmat3 m = tangent_from_mirror * mirror_from_cosine(p, lobe.alpha);
    inverse_ = glm::inverse(m);
    // In the cosine's space the horizon is a plane whose normal is the last row of M, and (1+n.z)/2
    // of a clamped cosine lies above it.
    const glm::dvec3 horizon = glm::normalize(glm::transpose(m)[2]);
    above_ = 0.5 * (1.0 + horizon.z);
    scale_ = std::numbers::inv_pi * std::abs(glm::determinant(inverse_)) / above_;
  }
  double density(const glm::dvec3& l) const {
    const glm::dvec3 c = inverse_ * l;
    const double length2 = glm::dot(c, c);
    return std::max(0.0, c.z) * scale_ / (length2 * length2);
  }
  double above_horizon() const { return above_; }

 private:
  glm::dmat3 inverse_;
  double above_, scale_;
};

/// The cross-entropy -integral lobe log(ltc).
double misfit(const Parameters& p, const LobeSamples& lobe) {
  constexpr double kLeastDensity = 1e-12;  // a direction that the transform misses costs this much
  const TransformedCosine ltc(p, lobe);
  // With its axis below the horizon, a far tail may fit as well, but the look-up loses its digits.
  if (!(ltc.above_horizon() >= 0.5)) return 1e30;
  double sum = 0.0;
  for (const LobePoint& point : lobe.points)
    sum -= point.weight * std::log(std::max(kLeastDensity, ltc.density(point.l)));
  return std::isfinite(sum) ? sum : 1e30;
}

}  // namespace

glm::dmat3 mirror_from_cosine(const Parameters& p, double alpha) {
  const double c = std::cos(alpha * p[3]), s = std::sin(alpha * p[3]);
  const glm::dmat3 turn(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c);
  const glm::dmat3 u(alpha * std::exp(p[0]), 0.0, 0.0, 0.0, alpha * std::exp(p[1]), 0.0,
                     alpha * p[2], 0.0, 1.0);
  return turn * u;
}

Fit fit_lobe(const LobeSamples& lobe, const Parameters& start, bool symmetric) {
  constexpr double kStep = 0.1;
  constexpr int kIterations = 400;
  constexpr double kTolerance = 1e-10;
  Parameters best;
  if (symmetric) {
    const auto round = [](const std::array<double, 1>& x) { return Parameters{x[0], x[0], 0, 0}; };
    best = round(nelder_mead(std::array<double, 1>{start[0]}, kStep, kIterations, kTolerance,
                             [&](const auto& x) { return misfit(round(x), lobe); }));
  } else {
    best = nelder_mead(start, kStep, kIterations, kTolerance,
                       [&](const Parameters& p) { return misfit(p, lobe); });
  }
  return {best, misfit(best, lobe)};
}

Parameters smooth_limit(const LobeSamples& lobe) {
  return {std::log(2.0), std::log(2.0 * lobe.v.z), 0.0, 0.0};
}

}  // namespace holdfast::fit
