#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "client/check/parts.h"
#include "client/check/residual.h"

namespace holdfast::check {
namespace {

constexpr double kNoise = 2e-5;   // relative depth
constexpr double kMisfit = 5e-3;  // relative depth; ours

glm::dmat4 matrix_of(const TransformTable& table, std::uint32_t id) {
  const auto it = table.find(id);
  return it == table.end() ? glm::dmat4(1) : it->second;
}

bool moves(const Pair& pair, std::uint32_t id) {
  const auto before = pair.before->objects.find(id);
  return before != pair.before->objects.end() && before->second != matrix_of(pair.now->objects, id);
}

/// Relative differences of depth of one object's samples; negative = no evidence.
using Differences = std::map<std::uint32_t, std::vector<float>>;

float difference(const Sighting& sighting) {
  switch (sighting.match) {
    case Match::kSurface: return static_cast<float>(sighting.difference);
    case Match::kNothing: return 1;
    default: return -1;
  }
}

Differences measure(const std::vector<Pair>& pairs, const Reading& reading,
                    const ObjectReading& objects) {
  Differences out;
  for (const Pair& pair : pairs) {
    const Seen now(*pair.now, reading), before(*pair.before, reading);
    const int step = sample_step(now.width(), now.height());
    for (int y = step / 2; y < now.height(); y += step)
      for (int x = step / 2; x < now.width(); x += step) {
        const std::uint32_t id = now.id_at(x, y);
        if (now.depth_at(x, y) <= 0 || id == 0) continue;
        const auto carry = objects.carry(pair, id);
        float value = -1;
        if (carry) {
          const glm::dvec4 point(now.position(x, y) + now.view.origin, 1);
          value = difference(look_for(before, glm::dvec3(*carry * point), id));
        }
        out[id].push_back(value);
      }
  }
  return out;
}

/// Samples of all objects for which `wanted` holds, in one row.
template <class F>
std::vector<float> joined(const Differences& differences, F wanted) {
  std::vector<float> all;
  for (const auto& [id, values] : differences)
    if (wanted(id)) all.insert(all.end(), values.begin(), values.end());
  return all;
}

/// A motion plane speaks for itself: its objects need no matrices.
bool has_motion(const std::vector<Pair>& pairs) {
  return std::any_of(pairs.begin(), pairs.end(), [](const Pair& pair) {
    return pair.now->find(PlaneKind::kMotion) != nullptr;
  });
}

void find_missing(const Differences& differences, double usual, Report& report,
                  const std::function<bool(std::uint32_t)>& moving) {
  for (const auto& [id, values] : differences) {
    if (moving(id)) continue;
    const std::int64_t samples =
        std::count_if(values.begin(), values.end(), [](float v) { return v >= 0; });
    const double median = median_residual(values);
    if (samples < kFewSamples || median < std::max(2e-3, 20 * usual)) continue;
    const std::int64_t off = std::count_if(values.begin(), values.end(),
                                           [&](float v) { return static_cast<double>(v) > 1e-3; });
    report.findings.push_back({"objects." + std::to_string(id), "object-missing",
                               "must be in the tables with its world_from_object where it moves",
                               percent(static_cast<double>(off) / static_cast<double>(samples)) +
                                   " of " + std::to_string(samples) +
                                   " pixels of it are not where they would be at rest: median "
                                   "difference of depth " +
                                   percent(median) + " against " + percent(usual) +
                                   " of all others at rest",
                               samples, static_cast<double>(off) / static_cast<double>(samples)});
  }
}

}  // namespace

std::optional<glm::dmat4> ObjectReading::carry(const Pair& pair, std::uint32_t id) const {
  if (!moves(pair, id)) return glm::dmat4(1);
  glm::dmat4 now = matrix_of(pair.now->objects, id), before = matrix_of(pair.before->objects, id);
  if (inverse) {
    now = glm::inverse(now);
    before = glm::inverse(before);
  }
  const double determinant = glm::determinant(now);
  if (determinant == 0 || !std::isfinite(1 / determinant)) return std::nullopt;
  return before * glm::inverse(now);
}

ObjectReading check_objects(const std::vector<Pair>& pairs, const Reading& reading,
                            Report& report) {
  ObjectReading objects;
  const std::size_t first = report.findings.size();
  Differences differences = measure(pairs, reading, objects);
  const auto moving = [&](std::uint32_t id) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& p) { return moves(p, id); });
  };
  const double usual =
      median_residual(joined(differences, [&](std::uint32_t id) { return !moving(id); }));
  const Differences inverse = measure(pairs, reading, {true});
  const Comparison c = compare_residuals(joined(differences, moving), joined(inverse, moving));
  if (clearly_better(c, kNoise)) {
    objects.inverse = true;
    differences = inverse;
    report.findings.push_back(
        {"objects", "object-inverse", "must take the object's own space to the world",
         percent(c.share) + " of " + std::to_string(c.samples) +
             " pixels of moving objects fit the earlier frame better with the inverse matrices: "
             "median difference of depth " +
             percent(c.other) + " against " + percent(c.given),
         c.samples, c.share});
  }
  if (usual < kMisfit && !has_motion(pairs)) find_missing(differences, usual, report, moving);

  const std::vector<float> moved = joined(differences, moving);
  const std::int64_t samples =
      std::count_if(moved.begin(), moved.end(), [](float v) { return v >= 0; });
  const double median = median_residual(moved);
  const std::string detail = "depth of moving objects in the earlier frame differs by " +
                             percent(median) + " (median of " + std::to_string(samples) +
                             " pixels)";
  if (report.findings.size() > first)
    report.add("objects", Verdict::kWrong, findings_since(report, first));
  else if (samples < kFewSamples)
    report.add("objects", Verdict::kNoEvidence, "too few pixels of objects that move");
  else
    report.add("objects", median > kMisfit ? Verdict::kUnclear : Verdict::kOk, detail);
  return objects;
}

}  // namespace holdfast::check
