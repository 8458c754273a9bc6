#include <cmath>

#include "client/check/parts.h"
#include "client/check/residual.h"

namespace holdfast::check {
namespace {

constexpr double kShare = 0.1;  // of the pixels; a few stray normals are usual

struct Counts {
  std::int64_t samples = 0, long_or_short = 0, facing_away = 0;
  double length = 0;
};

double given_length(const Snapshot& frame, int x, int y) {
  const Plane& plane = frame.planes.at({PlaneKind::kNormal, {}});
  glm::dvec3 n;
  for (int c = 0; c < 3; ++c) n[c] = static_cast<double>(plane.channel(c).at(x, y));
  return glm::length(n);
}

Counts count(const std::vector<Pair>& pairs, const Reading& reading) {
  Counts counts;
  for (const Pair& pair : pairs) {
    const Seen frame(*pair.now, reading);
    const int step = sample_step(frame.width(), frame.height());
    for (int y = step / 2; y < frame.height(); y += step)
      for (int x = step / 2; x < frame.width(); x += step) {
        const double length = given_length(*pair.now, x, y);
        if (frame.depth_at(x, y) <= 0 || !std::isfinite(length)) continue;
        ++counts.samples;
        counts.length += length;
        if (std::abs(length - 1) > 0.01) ++counts.long_or_short;
        // Shading normals lean a little beyond the horizon.
        const glm::dvec3 towards =
            frame.view.rays.far_weight > 0 ? frame.position(x, y) : frame.view.rays.forward;
        if (glm::dot(frame.normal(x, y), glm::normalize(towards)) > 0.2) ++counts.facing_away;
      }
  }
  return counts;
}

void report_share(std::int64_t bad, const Counts& counts, const char* mistake, const char* rule,
                  const std::string& what, Report& report) {
  const double share = static_cast<double>(bad) / static_cast<double>(counts.samples);
  if (share < kShare) return;
  report.findings.push_back(
      {"normal.X/Y/Z", mistake, rule,
       percent(share) + " of " + std::to_string(counts.samples) + " pixels " + what, counts.samples,
       share});
}

}  // namespace

void check_normals(const std::vector<Pair>& pairs, const Reading& reading, Report& report) {
  const Counts counts = count(pairs, reading);
  if (counts.samples < kFewSamples) return;
  const bool encoded = reading.normal == NormalReading::kEncodedWorld ||
                       reading.normal == NormalReading::kEncodedView;
  if (!encoded)
    report_share(counts.long_or_short, counts, "normal-length", "must be of unit length",
                 "have another length; the mean is " +
                     number(counts.length / static_cast<double>(counts.samples)),
                 report);
  report_share(counts.facing_away, counts, "normal-facing-away",
               "must be on the camera's side of the surface", "face away from the camera", report);
}

}  // namespace holdfast::check
