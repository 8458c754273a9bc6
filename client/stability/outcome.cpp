#include "client/stability/outcome.h"

#include <algorithm>
#include <cmath>

namespace holdfast::stability {
namespace {

/// Calls body(value of a, value of b) for every value of two planes of one size.
template <class Body>
void for_each_value(const Plane& a, const Plane& b, const Body& body) {
  for (int c = 0; c < a.channels(); ++c)
    for (int y = 0; y < a.height(); ++y)
      for (int x = 0; x < a.width(); ++x)
        body(double{a.channel(c).at(x, y)}, double{b.channel(c).at(x, y)});
}

double largest_value(const Plane& plane) {
  double largest = 0;
  for_each_value(plane, plane, [&](double v, double) { largest = std::max(largest, std::abs(v)); });
  return largest;
}

}  // namespace

double rmse(const Plane& a, const Plane& b) {
  double sum = 0, count = 0;
  for_each_value(a, b, [&](double va, double vb) {
    sum += (va - vb) * (va - vb);
    count += 1;
  });
  return std::sqrt(sum / count);
}

Outcome filter_world(const World& world, int frames) {
  Outcome outcome;
  Denoiser denoiser(session_of(world));
  for (int t = 0; t < frames; ++t)
    outcome.reports.push_back(denoiser.filter(render(world, t), outcome.results.emplace_back()));
  return outcome;
}

double relative_difference(const PlaneSet& a, const PlaneSet& b, double factor) {
  double worst = 0;
  for (const Plane& plane : a) {
    const double f = plane.id().kind == PlaneKind::kVisibility ? 1 : factor;
    const double most = f * largest_value(b.at(plane.id()));
    for_each_value(plane, b.at(plane.id()), [&](double va, double vb) {
      const double difference = std::abs(va - f * vb);
      const double relative = most > 0 ? difference / most : difference;
      worst = std::isfinite(va) && relative <= worst ? worst
              : std::isfinite(relative)              ? relative
                                                     : HUGE_VAL;
    });
  }
  return worst;
}

double relative_difference(const Outcome& a, const Outcome& b, double factor) {
  double worst = 0;
  for (std::size_t t = 0; t < a.results.size(); ++t)
    worst = std::max(worst, relative_difference(a.results[t], b.results[t], factor));
  return worst;
}

double noise_left(const World& world, int frames, std::optional<PlaneId> only) {
  const Outcome outcome = filter_world(world, frames);
  if (!all_finite(outcome)) return HUGE_VAL;
  const Frame noisy = render(world, frames - 1);
  double worst = 0;
  for (const Plane& mean : truth(world, frames - 1)) {
    if (only && mean.id() != *only) continue;
    const double before = rmse(noisy.planes.at(mean.id()), mean);
    const double after = rmse(outcome.results.back().at(mean.id()), mean);
    const double least = 1e-6 * std::max(1.0, largest_value(mean));
    worst = std::max(worst, before > least ? after / before : after);
  }
  return worst;
}

std::uint64_t repaired(const FrameReport& report, PlaneId plane) {
  for (const RepairCount& count : report.repaired)
    if (count.plane == plane) return count.values;
  return 0;
}

bool all_finite(const Outcome& outcome) {
  for (const FrameReport& report : outcome.reports)
    if (report.non_finite_out > 0 || !std::isfinite(report.mean_history_frames)) return false;
  for (const PlaneSet& results : outcome.results)
    if (!(relative_difference(results, results) <= 0)) return false;
  return true;
}

}  // namespace holdfast::stability
