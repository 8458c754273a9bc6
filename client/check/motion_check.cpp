#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "client/check/parts.h"
#include "client/check/residual.h"

namespace holdfast::check {
namespace {

/// One thing that can be wrong about motion vectors. The bits of a set of them combine.
struct Fault {
  unsigned bit;
  const char* name;
  const char* found;
};
constexpr unsigned kSign = 1, kNormalised = 2, kNdc = 4, kFlipY = 8, kSwap = 16, kJitter = 32;
constexpr std::array<Fault, 6> kFaults{
    {{kSign, "motion-sign", "the opposite sign (current minus previous)"},
     {kNormalised, "motion-normalised", "fractions of the image as unit"},
     {kNdc, "motion-ndc", "normalised device coordinates as unit (y upwards)"},
     {kFlipY, "motion-flipped-y", "y upwards"},
     {kSwap, "motion-swapped", "X and Y swapped"},
     {kJitter, "motion-jittered", "the jitter of both frames within it"}}};

/// Motion of a sample: as given, and as depth and matrices have it; pixels.
struct Sample {
  glm::dvec2 given, expected, jitter;
};

struct Size {
  double width, height;
};

glm::dvec2 read(const Sample& sample, unsigned faults, Size size) {
  glm::dvec2 m = sample.given;
  if (faults & kSwap) m = {m.y, m.x};
  if (faults & kNormalised) m *= glm::dvec2(size.width, size.height);
  if (faults & kNdc) m *= glm::dvec2(size.width, -size.height) / 2.0;
  if (faults & kFlipY) m.y = -m.y;
  if (faults & kSign) m = -m;
  if (faults & kJitter) m -= sample.jitter;
  return m;
}

/// Samples that moved and whose surface is seen in the earlier frame as expected, so that geometry
/// that deforms or was hidden does not count.
std::vector<Sample> samples_of(const std::vector<Pair>& pairs, const Reading& reading,
                               const ObjectReading& objects) {
  constexpr double kLeastMotion = 0.05;  // pixels
  constexpr double kFits = 5e-3;         // relative depth
  std::vector<Sample> samples;
  for (const Pair& pair : pairs) {
    const Plane* plane = pair.now->find(PlaneKind::kMotion);
    if (!plane) continue;
    const Seen now(*pair.now, reading), before(*pair.before, reading);
    const int step = sample_step(now.width(), now.height());
    for (int y = step / 2; y < now.height(); y += step)
      for (int x = step / 2; x < now.width(); x += step) {
        if (now.depth_at(x, y) <= 0) continue;
        const std::uint32_t id = now.id_at(x, y);
        const auto carry = objects.carry(pair, id);
        if (!carry) continue;
        const glm::dvec4 point(now.position(x, y) + now.view.origin, 1);
        const Sighting sighting = look_for(before, glm::dvec3(*carry * point), id);
        if (sighting.match != Match::kSurface || sighting.difference > kFits) continue;
        const glm::dvec2 expected = sighting.pixel - now.sample(x, y);
        const glm::dvec2 given(static_cast<double>(plane->channel(0).at(x, y)),
                               static_cast<double>(plane->channel(1).at(x, y)));
        if (glm::length(expected) < kLeastMotion || !(glm::length(given) < 1e9)) continue;
        samples.push_back({given, expected, now.jitter - before.jitter});
      }
  }
  return samples;
}

std::vector<float> residuals(const std::vector<Sample>& samples, unsigned faults, Size size) {
  std::vector<float> out;
  for (const Sample& s : samples)
    out.push_back(static_cast<float>(glm::distance(read(s, faults, size), s.expected)));
  return out;
}

bool sensible(unsigned faults) { return (faults & (kNormalised | kNdc)) != (kNormalised | kNdc); }

/// The fewest faults that explain the motion about as well as any.
std::pair<unsigned, Comparison> explain(const std::vector<Sample>& samples, Size size) {
  constexpr double kNoise = 0.02;  // pixels
  constexpr unsigned kAll = 64;
  const std::vector<float> given = residuals(samples, 0, size);
  std::array<Comparison, kAll> tried{};
  double least = median_residual(given);
  for (unsigned faults = 1; faults < kAll; ++faults) {
    if (!sensible(faults)) continue;
    tried[faults] = compare_residuals(given, residuals(samples, faults, size));
    if (clearly_better(tried[faults], kNoise)) least = std::min(least, tried[faults].other);
  }
  unsigned best = 0;
  for (unsigned faults = 1; faults < kAll; ++faults)
    if (sensible(faults) && clearly_better(tried[faults], kNoise) &&
        tried[faults].other <= 1.5 * least + kNoise / 2 &&
        (best == 0 || std::popcount(faults) < std::popcount(best)))
      best = faults;
  return {best, tried[best]};
}

Finding finding(unsigned faults, const Comparison& c) {
  std::string name, found;
  for (const Fault& fault : kFaults) {
    if (!(faults & fault.bit)) continue;
    name += (name.empty() ? "" : "+") + std::string(fault.name);
    found += (found.empty() ? "" : ", and ") + std::string(fault.found);
  }
  return {"motion.X/Y",
          name,
          "must be in pixels, previous minus current, y downwards, unjittered",
          percent(c.share) + " of " + std::to_string(c.samples) + " pixels fit better with " +
              found + ": median residual " + number(c.other) + " px against " + number(c.given) +
              " px",
          c.samples,
          c.share};
}

}  // namespace

void check_motion(const std::vector<Pair>& near, const Reading& reading,
                  const ObjectReading& objects, Report& report) {
  const bool given = std::any_of(near.begin(), near.end(), [](const Pair& pair) {
    return pair.now->find(PlaneKind::kMotion) != nullptr;
  });
  if (!given) return;
  const auto samples = samples_of(near, reading, objects);
  if (static_cast<std::int64_t>(samples.size()) < kFewSamples) {
    report.add("motion", Verdict::kNoEvidence, "nothing moves that depth and matrices explain");
    return;
  }
  const Size size{static_cast<double>(near.front().now->width()),
                  static_cast<double>(near.front().now->height())};
  if (const auto [faults, comparison] = explain(samples, size); faults != 0) {
    report.findings.push_back(finding(faults, comparison));
    report.add("motion", Verdict::kWrong, findings_since(report, report.findings.size() - 1));
    return;
  }
  const double median = median_residual(residuals(samples, 0, size));
  std::vector<float> lengths;
  for (const Sample& s : samples) lengths.push_back(static_cast<float>(glm::length(s.expected)));
  const double length = median_residual(lengths);
  const std::string detail = "differs from the motion of depth and matrices by " + number(median) +
                             " px (median of " + std::to_string(samples.size()) +
                             " pixels that moved by " + number(length) + " px)";
  report.add("motion", median > std::max(0.1, 0.25 * length) ? Verdict::kUnclear : Verdict::kOk,
             detail);
}

}  // namespace holdfast::check
