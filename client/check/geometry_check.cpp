#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "client/check/parts.h"
#include "client/check/residual.h"
#include "core/frame/error.h"

namespace holdfast::check {
namespace {

// Residuals below these are noise, above the second figure a misfit. Ours.
constexpr double kDepthNoise = 2e-5, kDepthMisfit = 5e-3;  // relative depth
constexpr double kNormalNoise = 2, kNormalMisfit = 15;     // degrees

/// Residuals of every sample under one reading; negative where there is no evidence.
struct Residuals {
  std::vector<float> depth;   ///< relative difference of depth in the earlier frame; 1 = not there
  std::vector<float> normal;  ///< angle between the given normal and the one from depth, degrees
  std::vector<float> moved;   ///< how far the sample moved in the image, pixels
};

bool at_rest(const Pair& pair, std::uint32_t id) {
  const auto now = pair.now->objects.find(id), before = pair.before->objects.find(id);
  if (now == pair.now->objects.end()) return true;
  return before == pair.before->objects.end() || before->second == now->second;
}

void add_sample(const Seen& now, const Seen& before, int x, int y, bool carried, Residuals& out) {
  float depth = -1, normal = -1, moved = -1;
  if (now.depth_at(x, y) > 0) {
    if (carried) {
      const glm::dvec3 point = now.position(x, y) + now.view.origin;
      const Sighting sighting = look_for(before, point, now.id_at(x, y));
      if (sighting.match == Match::kSurface)
        depth = static_cast<float>(sighting.difference);
      else if (sighting.match != Match::kUnusable)
        depth = 1;
      if (sighting.match != Match::kOutside)
        moved = static_cast<float>(glm::distance(sighting.pixel, now.sample(x, y)));
    }
    const glm::dvec3 given = now.normal(x, y);
    if (const auto expected = normal_from_depth(now, x, y); expected && given != glm::dvec3(0)) {
      const double cosine = std::clamp(glm::dot(*expected, given), -1.0, 1.0);
      normal = static_cast<float>(glm::degrees(std::acos(cosine)));
    }
  }
  out.depth.push_back(depth);
  out.normal.push_back(normal);
  out.moved.push_back(moved);
}

Residuals measure(const std::vector<Pair>& pairs, const Reading& reading) {
  Residuals out;
  for (const Pair& pair : pairs) {
    const Seen now(*pair.now, reading), before(*pair.before, reading);
    const int step = sample_step(now.width(), now.height());
    for (int y = step / 2; y < now.height(); y += step)
      for (int x = step / 2; x < now.width(); x += step)
        add_sample(now, before, x, y, at_rest(pair, now.id_at(x, y)), out);
  }
  return out;
}

/// How a changed reading compares with the one before.
struct Change {
  Comparison depth, normal;
  bool by_depth = false, by_normal = false, worse = false;
  double gain = 0;

  Change() = default;
  Change(const Residuals& from, const Residuals& to)
      : depth(compare_residuals(from.depth, to.depth)),
        normal(compare_residuals(from.normal, to.normal)),
        by_depth(clearly_better(depth, kDepthNoise)),
        by_normal(clearly_better(normal, kNormalNoise)) {
    const double d0 = std::max(depth.given, kDepthNoise), d1 = std::max(depth.other, kDepthNoise);
    const double n0 = std::max(normal.given, kNormalNoise);
    const double n1 = std::max(normal.other, kNormalNoise);
    worse = d1 > 1.5 * d0 || n1 > 1.5 * n0;
    gain = std::log(d0 / d1) + std::log(n0 / n1);
  }
  bool clear() const { return (by_depth || by_normal) && !worse; }
};

std::string evidence(const Change& change, const Mistake& mistake) {
  const std::string than = std::string(" with ") + mistake.found;
  std::string text;
  if (change.by_depth)
    text = percent(change.depth.share) + " of " + std::to_string(change.depth.samples) +
           " pixels fit the earlier frame better" + than + ": median difference of depth " +
           percent(change.depth.other) + " against " + percent(change.depth.given);
  if (change.by_normal)
    text += (text.empty() ? "" : "; ") + percent(change.normal.share) + " of " +
            std::to_string(change.normal.samples) + " normals fit the depth better" + than +
            ": median angle " + number(change.normal.other) + " against " +
            number(change.normal.given) + " degrees";
  return text;
}

Finding finding(const Change& change, const Mistake& mistake) {
  const Comparison& c = change.by_depth ? change.depth : change.normal;
  return {mistake.thing, mistake.name, mistake.rule, evidence(change, mistake), c.samples, c.share};
}

/// The reading with the most gain among those that are clear, by one mistake more or, where none
/// makes everything fit, by two.
class Search {
 public:
  explicit Search(const std::vector<Pair>& pairs)
      : pairs_(pairs), residuals_(measure(pairs, reading_)) {}

  /// Takes the best step and reports it; false if there is none.
  bool step(Report& report) {
    Change best;
    Residuals best_residuals;
    std::vector<const Mistake*> steps;
    const auto consider = [&](std::vector<const Mistake*> mistakes) {
      Reading changed = reading_;
      for (const Mistake* mistake : mistakes) mistake->apply(changed);
      Residuals residuals;
      try {
        residuals = measure(pairs_, changed);
      } catch (const InputError&) {
        return;  // a singular camera is no candidate
      }
      const Change change(residuals_, residuals);
      if (!change.clear() || change.gain <= best.gain) return;
      best = change;
      best_residuals = std::move(residuals);
      steps = std::move(mistakes);
    };
    const auto& mistakes = geometry_mistakes();
    for (const Mistake& one : mistakes) consider({&one});
    if (fits_badly(steps.empty() ? residuals_ : best_residuals))
      for (const Mistake& one : mistakes)
        for (const Mistake* two = &one + 1; two != mistakes.data() + mistakes.size(); ++two)
          if (std::string_view(one.thing) != two->thing) consider({&one, two});
    for (const Mistake* mistake : steps) {
      mistake->apply(reading_);
      report.findings.push_back(finding(best, *mistake));
    }
    if (!steps.empty()) residuals_ = std::move(best_residuals);
    return !steps.empty();
  }

  const Reading& reading() const { return reading_; }
  double depth() const { return median_residual(residuals_.depth); }
  double normal() const { return median_residual(residuals_.normal); }
  double moved() const { return median_residual(residuals_.moved); }
  std::int64_t samples(const std::vector<float>& of) const {
    return std::count_if(of.begin(), of.end(), [](float r) { return r >= 0; });
  }
  std::int64_t depth_samples() const { return samples(residuals_.depth); }
  std::int64_t normal_samples() const { return samples(residuals_.normal); }

 private:
  static bool fits_badly(const Residuals& residuals) {
    return median_residual(residuals.depth) > kDepthMisfit ||
           median_residual(residuals.normal) > kNormalMisfit;
  }

  const std::vector<Pair>& pairs_;
  Reading reading_;
  Residuals residuals_;
};

void report_lines(const Search& search, const Report& before, Report& report) {
  bool camera = false, normal = false;
  for (std::size_t i = before.findings.size(); i < report.findings.size(); ++i)
    (report.findings[i].thing.starts_with("normal") ? normal : camera) = true;
  const std::string depth_detail = "depth in the earlier frame differs by " +
                                   percent(search.depth()) + " (median of " +
                                   std::to_string(search.depth_samples()) +
                                   " pixels that moved by " + number(search.moved()) + " px)";
  if (camera)
    report.add("camera", Verdict::kWrong, "put right: " + depth_detail);
  else if (search.depth_samples() < kFewSamples)
    report.add("camera", Verdict::kNoEvidence, "too few pixels at rest in the world");
  else if (search.depth() > kDepthMisfit)
    report.add("camera", Verdict::kUnclear, depth_detail);
  else if (search.moved() < 0.02)
    report.add("camera", Verdict::kNoEvidence, "the camera stands still");
  else
    report.add("camera", Verdict::kOk, depth_detail);

  const std::string normal_detail = "angle to the normal from depth " + number(search.normal()) +
                                    " degrees (median of " +
                                    std::to_string(search.normal_samples()) + " pixels)";
  if (normal)
    report.add("normal", Verdict::kWrong, "put right: " + normal_detail);
  else if (search.normal_samples() < kFewSamples)
    report.add("normal", Verdict::kNoEvidence, "too few pixels with neighbours of their object");
  else
    report.add("normal", search.normal() > kNormalMisfit ? Verdict::kUnclear : Verdict::kOk,
               normal_detail);
}

}  // namespace

Reading check_geometry(const std::vector<Pair>& pairs, Report& report) {
  const Report before = report;
  Search search(pairs);
  constexpr int kSteps = 4;  // camera, projection or depth, normals, jitter
  for (int i = 0; i < kSteps && search.step(report); ++i) {
  }
  report_lines(search, before, report);
  return search.reading();
}

}  // namespace holdfast::check
