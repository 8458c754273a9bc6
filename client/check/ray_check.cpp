#include <algorithm>
#include <array>
#include <cmath>

#include "client/check/floating.h"
#include "client/check/parts.h"
#include "client/check/residual.h"

namespace holdfast::check {
namespace {

/// What directions of rays could be.
struct DirectionReading {
  bool view, reversed;
  const char* mistake;
  const char* found;
};
constexpr std::array<DirectionReading, 4> kReadings{
    {{false, false, "", ""},
     {false, true, "direction-reversed", "the opposite sign"},
     {true, false, "direction-view-space", "view space"},
     {true, true, "direction-view-space-reversed", "view space with the opposite sign"}}};

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(whole, 1));
}

struct Counts {
  std::int64_t rays = 0, not_unit = 0, hits = 0;
  // Under each reading:
  std::array<std::int64_t, kReadings.size()> below{};     ///< rays below the horizon
  std::array<std::int64_t, kReadings.size()> floating{};  ///< hits that would hide what is shown

  double misfit(std::size_t i) const { return share(below[i], rays) + share(floating[i], hits); }
};

void add_ray(const Seen& frame, const glm::dmat3& world_from_view, const Plane* distance, int x,
             int y, glm::dvec3 d, Counts& counts) {
  const double length = glm::length(d);
  const glm::dvec3 n = frame.normal(x, y), surface = frame.position(x, y);
  if (!(length > 0) || !std::isfinite(length)) return;
  if (glm::dot(n, surface) > 0) return;  // faces away, which check_normals reports
  ++counts.rays;
  counts.not_unit += std::abs(length - 1) > 1e-2 ? 1 : 0;
  const auto t = static_cast<double>(distance ? distance->channel(0).at(x, y) : -1.0f);
  const bool hit = t >= 0 && std::isfinite(t);
  counts.hits += hit ? 1 : 0;
  for (std::size_t i = 0; i < kReadings.size(); ++i) {
    const glm::dvec3 unit = (kReadings[i].reversed ? -d : d) / length;
    const glm::dvec3 world = kReadings[i].view ? world_from_view * unit : unit;
    counts.below[i] += glm::dot(world, n) < -0.02 ? 1 : 0;
    counts.floating[i] += hit && floats(frame, surface + t * world) ? 1 : 0;
  }
}

Counts count(const std::vector<Pair>& pairs, const Reading& reading, PlaneKind directions,
             bool with_hits) {
  Counts counts;
  for (const Pair& pair : pairs) {
    const Plane* direction = pair.now->find(directions);
    if (!direction) continue;
    const Plane* distance = with_hits ? pair.now->find(PlaneKind::kGlossyHitDistance) : nullptr;
    const Seen frame(*pair.now, reading);
    const PixelRays<double>& rays = frame.view.rays;
    const glm::dvec3 back = -rays.forward, right = glm::normalize(rays.lateral_x);
    const glm::dmat3 world_from_view(right, glm::cross(back, right), back);
    const int step = sample_step(frame.width(), frame.height());
    for (int y = step / 2; y < frame.height(); y += step)
      for (int x = step / 2; x < frame.width(); x += step) {
        if (frame.depth_at(x, y) <= 0) continue;
        glm::dvec3 d;
        for (int c = 0; c < 3; ++c) d[c] = static_cast<double>(direction->channel(c).at(x, y));
        add_ray(frame, world_from_view, distance, x, y, d, counts);
      }
  }
  return counts;
}

/// True if the directions are wrong; then hits along them say nothing.
bool report_directions(const std::string& thing, const Counts& c, Report& report) {
  if (const double bad = share(c.not_unit, c.rays); bad > 0.01) {
    report.findings.push_back(
        {thing, "direction-length", "must be of unit length, or (0,0,0)",
         percent(bad) + " of " + std::to_string(c.rays) + " directions have another length", c.rays,
         bad});
    return true;
  }
  constexpr double kFew = 0.05;  // shading normals let some through
  const double below = share(c.below[0], c.rays);
  std::string mistake = "direction-below-horizon", better;
  double least = 0.25 * c.misfit(0);
  for (std::size_t i = 1; i < kReadings.size(); ++i)
    if (c.misfit(0) > kFew && c.misfit(i) < least) {
      least = c.misfit(i);
      mistake = kReadings[i].mistake;
      better = std::string("; with ") + kReadings[i].found + " " +
               percent(share(c.below[i], c.rays)) + " and " + percent(share(c.floating[i], c.hits));
    }
  if (below <= kFew && better.empty()) return false;
  report.findings.push_back(
      {thing, mistake, "must be in world space, from the surface to where light comes from",
       percent(below) + " of " + std::to_string(c.rays) +
           " directions go below the horizon of their normal, and " +
           percent(share(c.floating[0], c.hits)) + " of " + std::to_string(c.hits) +
           " hits are where the frame shows nothing so near" + better,
       c.rays, std::min(c.misfit(0), 1.0)});
  return true;
}

void check_plane(const std::vector<Pair>& pairs, const Reading& reading, PlaneKind kind,
                 const char* name, bool with_hits, Report& report) {
  const bool given = std::any_of(pairs.begin(), pairs.end(),
                                 [&](const Pair& pair) { return pair.now->find(kind); });
  if (!given) return;
  const std::size_t first = report.findings.size();
  const Counts counts = count(pairs, reading, kind, with_hits);
  if (counts.rays < kFewSamples) {
    report.add(name, Verdict::kNoEvidence, "too few directions");
    return;
  }
  const bool wrong = report_directions(plane_name({kind, {}}) + ".X/Y/Z", counts, report);
  const double floating = share(counts.floating[0], counts.hits);
  if (!wrong && counts.hits >= kFewSamples && floating > 0.3)
    report.findings.push_back({"glossy.hitDistance", "hit-floating",
                               "must be metres from the surface to what was hit",
                               percent(floating) + " of " + std::to_string(counts.hits) +
                                   " hits are where the frame shows nothing so near",
                               counts.hits, floating});
  if (report.findings.size() > first) {
    report.add(name, Verdict::kWrong, findings_since(report, first));
    return;
  }
  std::string detail = percent(share(counts.below[0], counts.rays)) + " of " +
                       std::to_string(counts.rays) + " directions below the horizon";
  if (counts.hits > 0)
    detail +=
        ", " + percent(floating) + " of " + std::to_string(counts.hits) + " hits in odd places";
  report.add(name, Verdict::kOk, detail);
}

}  // namespace

void check_rays(const std::vector<Pair>& pairs, const Reading& reading, Report& report) {
  check_plane(pairs, reading, PlaneKind::kGlossyDirection, "glossy", true, report);
  check_plane(pairs, reading, PlaneKind::kIndirectDirection, "indirect", false, report);
}

}  // namespace holdfast::check
