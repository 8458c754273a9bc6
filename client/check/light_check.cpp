#include <algorithm>
#include <cmath>

#include "client/check/floating.h"
#include "client/check/parts.h"
#include "client/check/residual.h"

namespace holdfast::check {
namespace {

/// The planes of one light in one frame; null where they are not there.
struct LightPlanes {
  LightPlanes(const PlaneSet& planes, std::uint32_t id)
      : unshadowed(planes.find(PlaneId::of_light(PlaneKind::kUnshadowed, id))),
        visibility(planes.find(PlaneId::of_light(PlaneKind::kVisibility, id))),
        distance(planes.find(PlaneId::of_light(PlaneKind::kBlockerDistance, id))),
        sample(planes.find(PlaneId::of_light(PlaneKind::kLightSample, id))) {}

  bool lit(int x, int y) const {
    for (int c = 0; unshadowed && c < 3; ++c)
      if (unshadowed->channel(c).at(x, y) > 0) return true;
    return false;
  }

  const Plane *unshadowed, *visibility, *distance, *sample;
};

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(whole, 1));
}

/// What was seen of one light under one reading of its matrix.
struct Counts {
  std::int64_t lit = 0;        ///< pixels that the light reaches, by `unshadowed`
  std::int64_t behind = 0;     ///< of them: behind a light that emits from one side
  std::int64_t blocked = 0;    ///< pixels with a blocker
  std::int64_t beyond = 0;     ///< of them: the blocker lies beyond the light sample
  std::int64_t floating = 0;   ///< of them: the blocker would hide what the frame shows there
  std::int64_t bright = 0;     ///< of them: visibility is 1
  std::int64_t free = 0;       ///< lit pixels without a blocker
  std::int64_t dark = 0;       ///< of them: visibility is 0
  std::int64_t samples = 0;    ///< light samples
  std::int64_t off_light = 0;  ///< of them: outside [0,1]^2
  bool fractions = false;      ///< visibility has other values than 0 and 1

  double misfit() const { return share(behind + beyond + floating, lit + blocked); }
};

class LightCount {
 public:
  LightCount(const Light& light, bool inverse) : light_(light), inverse_(inverse) {}

  void add(const Seen& frame) {
    const LightPlanes planes(frame.snapshot->planes, light_.id);
    const auto it = frame.snapshot->lights.find(light_.id);
    matrix_ = it == frame.snapshot->lights.end() ? glm::dmat4(1) : it->second;
    if (inverse_) matrix_ = glm::inverse(matrix_);
    const int step = sample_step(frame.width(), frame.height());
    for (int y = step / 2; y < frame.height(); y += step)
      for (int x = step / 2; x < frame.width(); x += step)
        if (frame.depth_at(x, y) > 0) add_pixel(frame, planes, x, y);
  }
  const Counts& counts() const { return counts_; }

 private:
  void add_pixel(const Seen& frame, const LightPlanes& planes, int x, int y) {
    const glm::dvec3 surface = frame.position(x, y);
    const bool lit = planes.lit(x, y);
    if (lit) {
      ++counts_.lit;
      counts_.behind += is_behind(frame, surface) ? 1 : 0;
    }
    const float distance = planes.distance ? planes.distance->channel(0).at(x, y) : -1.0f;
    const bool blocked = distance >= 0 && std::isfinite(distance);
    if (blocked && planes.sample) add_blocker(frame, planes, x, y, static_cast<double>(distance));
    if (blocked) ++counts_.blocked;
    if (!planes.visibility) return;
    const float visibility = planes.visibility->channel(0).at(x, y);
    counts_.fractions = counts_.fractions || (visibility != 0 && visibility != 1);
    if (blocked && visibility == 1) ++counts_.bright;
    if (!lit || !planes.distance || distance < 0 || blocked) return;
    ++counts_.free;
    if (visibility == 0) ++counts_.dark;
  }

  void add_blocker(const Seen& frame, const LightPlanes& planes, int x, int y, double distance) {
    const glm::dvec2 uv(static_cast<double>(planes.sample->channel(0).at(x, y)),
                        static_cast<double>(planes.sample->channel(1).at(x, y)));
    ++counts_.samples;
    if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) {
      ++counts_.off_light;
      return;
    }
    const glm::dvec4 at = matrix_ * light_point(light_, uv.x, uv.y);
    const glm::dvec3 surface = frame.position(x, y);
    const glm::dvec3 towards =
        at.w != 0 ? glm::dvec3(at) - frame.view.origin - surface : glm::dvec3(at);
    const double length = glm::length(towards);
    if (!(length > 0)) return;
    if (at.w != 0 && distance > length * 1.001 + 1e-4)
      ++counts_.beyond;
    else if (floats(frame, surface + towards / length * distance))
      ++counts_.floating;
  }

  bool is_behind(const Seen& frame, const glm::dvec3& surface) const {
    if (light_.shape != LightShape::kRectangle && light_.shape != LightShape::kDisk) return false;
    const glm::dvec3 from_light = surface + frame.view.origin - glm::dvec3(matrix_[3]);
    return glm::dot(from_light, glm::dvec3(matrix_[2])) > 1e-3;
  }

  const Light& light_;
  bool inverse_;
  glm::dmat4 matrix_{1};
  Counts counts_;
};

Counts count(const std::vector<Pair>& pairs, const Light& light, const Reading& reading,
             bool inverse) {
  LightCount count(light, inverse);
  for (const Pair& pair : pairs) count.add(Seen(*pair.now, reading));
  return count.counts();
}

/// Reports what more than `limit` of `total` pixels show.
bool report_share(const std::string& thing, const char* mistake, const char* rule, const char* what,
                  std::int64_t bad, std::int64_t total, double limit, Report& report) {
  if (total < kFewSamples) return false;
  const double part = share(bad, total);
  if (part <= limit) return false;
  report.findings.push_back({thing, mistake, rule,
                             percent(part) + " of " + std::to_string(total) + " pixels " + what,
                             total, part});
  return true;
}

/// Leaves in `counts` what the later rules are judged by.
void report_matrix(const Light& light, const Counts& inverse, Counts& counts, Report& report) {
  constexpr double kMisfit = 0.04, kFits = 0.1;  // kFits as part of the misfit
  const std::string thing = "lights." + std::to_string(light.id);
  const std::int64_t total = counts.lit + counts.blocked;
  if (total < kFewSamples) return;
  if (counts.misfit() > kMisfit && inverse.misfit() < kFits * counts.misfit()) {
    report.findings.push_back({thing, "light-inverse", "must be world_from_light",
                               percent(counts.misfit()) + " of " + std::to_string(total) +
                                   " pixels and blockers cannot be where they are, with the "
                                   "inverse matrix " +
                                   percent(inverse.misfit()),
                               total, counts.misfit()});
    counts = inverse;
  } else if (report_share(thing, "light-backwards", "must emit along its local -Z",
                          "that it lights are behind it", counts.behind, counts.lit, 0.5, report)) {
    counts.beyond = counts.floating = 0;  // its samples are mirrored too
  }
}

void report_blockers(const std::string& light, const Counts& c, Report& report) {
  const bool off_light = report_share(light + ".sampleU/V", "sample-range", "must be in [0,1]^2",
                                      "have another sample", c.off_light, c.samples, 0.001, report);
  if (!off_light &&
      !report_share(light + ".blockerDistance", "blocker-beyond-light",
                    "must be metres from the surface, less than to the light sample",
                    "have a blocker beyond the light sample", c.beyond, c.blocked, 0.02, report))
    report_share(light + ".blockerDistance", "blocker-floating",
                 "must be metres from the surface along the ray to the light sample",
                 "have a blocker where the frame shows nothing so near: distance, sample or the "
                 "light's matrix is wrong",
                 c.floating, c.blocked, 0.3, report);
  if (c.fractions) return;  // of several samples one may be blocked, and their mean be anything
  constexpr double kFew = 0.05;
  if (share(c.bright, c.blocked) > kFew && share(c.dark, c.free) > kFew) {
    report_share(light + ".visibility", "visibility-inverted",
                 "must be 1 where the light is seen and 0 where it is blocked", "have the opposite",
                 c.bright + c.dark, c.blocked + c.free, kFew, report);
    return;
  }
  report_share(light + ".visibility", "blocked-yet-visible", "must be 0 where there is a blocker",
               "with a blocker have 1", c.bright, c.blocked, kFew, report);
  report_share(light + ".visibility", "unblocked-yet-dark",
               "must not be 0 where the light reaches and nothing blocks it",
               "without a blocker have 0", c.dark, c.free, kFew, report);
}

}  // namespace

void check_lights(const std::vector<Pair>& pairs, const std::vector<Light>& lights,
                  const Reading& reading, Report& report) {
  for (const Light& light : lights) {
    const std::string name = "light" + std::to_string(light.id);
    const std::size_t first = report.findings.size();
    Counts counts = count(pairs, light, reading, false);
    const Counts inverse = count(pairs, light, reading, true);
    report_matrix(light, inverse, counts, report);
    report_blockers(name, counts, report);
    if (report.findings.size() > first)
      report.add(name, Verdict::kWrong, findings_since(report, first));
    else if (counts.lit + counts.blocked < kFewSamples)
      report.add(name, Verdict::kNoEvidence,
                 "too few pixels that it lights or that have a blocker");
    else
      report.add(name, Verdict::kOk,
                 std::to_string(counts.blocked) + " blockers and " + std::to_string(counts.lit) +
                     " lit pixels, " + percent(counts.misfit()) + " of them in odd places");
  }
}

}  // namespace holdfast::check
