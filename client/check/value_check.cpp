#include <algorithm>
#include <cmath>

#include "client/check/parts.h"
#include "core/frame/conventions.h"

namespace holdfast::check {
namespace {

bool is_distance(PlaneKind kind) {
  return kind == PlaneKind::kBlockerDistance || kind == PlaneKind::kGlossyHitDistance;
}

/// +inf has a meaning there: nothing was hit.
bool may_be_infinite(PlaneKind kind) { return kind == PlaneKind::kDepth || is_distance(kind); }

/// Planes whose values are 0 or more.
bool is_positive(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::kRoughness:
    case PlaneKind::kAlbedo:
    case PlaneKind::kSpecular:
    case PlaneKind::kEmission:
    case PlaneKind::kUnshadowed:
    case PlaneKind::kVisibility:
    case PlaneKind::kGlossy:
    case PlaneKind::kIndirect: return true;
    default: return is_distance(kind);
  }
}

/// Planes whose mean is 1 at most.
bool is_fraction(PlaneKind kind) {
  return kind == PlaneKind::kRoughness || kind == PlaneKind::kVisibility;
}

}  // namespace

void ValueCheck::add(const PlaneSet& planes) {
  const auto depth = planes.at({PlaneKind::kDepth, {}}).channel(0);
  for (const Plane& plane : planes) {
    if (plane.is_uint()) continue;
    Count& count = counts_[plane.id()];
    const PlaneKind kind = plane.id().kind;
    const bool sky_counts = kind == PlaneKind::kDepth || kind == PlaneKind::kEmission;
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x) {
          if (!sky_counts && !is_surface(depth.at(x, y))) continue;
          const float value = plane.channel(c).at(x, y);
          ++count.values;
          if (std::isfinite(value))
            count.sum += static_cast<double>(value);
          else if (std::isnan(value) || value < 0 || !may_be_infinite(kind))
            ++count.not_finite;
          if (value < 0) ++count.negative;
        }
  }
}

void ValueCheck::report(Report& report) const {
  const std::size_t first = report.findings.size();
  const auto find = [&](PlaneId id, const char* mistake, const std::string& rule,
                        const std::string& evidence, const Count& count, std::int64_t bad) {
    report.findings.push_back({plane_name(id), mistake, rule, evidence, count.values,
                               static_cast<double>(bad) / static_cast<double>(count.values)});
  };
  for (const auto& [id, count] : counts_) {
    const std::string of = " of " + std::to_string(count.values) + " values ";
    if (count.not_finite > 0)
      find(id, "not-finite",
           may_be_infinite(id.kind) ? "must be finite, or +inf where there is nothing"
                                    : "must be finite",
           std::to_string(count.not_finite) + of + "are not", count, count.not_finite);
    // A few negative lobes of a reconstruction filter are no mistake; a negative distance is.
    const double few = is_distance(id.kind) ? 0 : 0.001 * static_cast<double>(count.values);
    if (is_positive(id.kind) && static_cast<double>(count.negative) > few)
      find(id, "negative", "must be 0 or more",
           std::to_string(count.negative) + of + "are negative", count, count.negative);
    const double mean = count.sum / static_cast<double>(std::max<std::int64_t>(count.values, 1));
    if (is_fraction(id.kind) && mean > 1.05)
      find(id, "above-one",
           id.kind == PlaneKind::kVisibility ? "must have a mean of 1 at most" : "must be in 0..1",
           "the mean is " + number(mean), count, count.values);
  }
  report.add("values", report.findings.size() > first ? Verdict::kWrong : Verdict::kOk,
             report.findings.size() > first ? findings_since(report, first)
                                            : std::to_string(counts_.size()) + " planes");
}

}  // namespace holdfast::check
