#include <algorithm>
#include <cmath>

#include "client/stability/oracle_study.h"
#include "core/denoiser/plan.h"
#include "core/oracle/frame_oracle.h"

namespace holdfast::stability {
namespace {

/// The largest value of a plane over all frames.
double largest_value(const Results& results, PlaneId id) {
  double largest = 0;
  for (const PlaneSet& planes : results) {
    const Plane& plane = planes.at(id);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        for (int x = 0; x < plane.width(); ++x)
          largest = std::max(largest, std::abs(double{plane.channel(c).at(x, y)}));
  }
  return largest > 0 ? largest : 1;
}

/// What an error is a share of.
double unit_of(const Results& doubles, PlaneId id) {
  switch (id.kind) {
    case PlaneKind::kVisibility:
    case PlaneKind::kDebugMotion:
    case PlaneKind::kDebugConfidence: return 1;
    default: return largest_value(doubles, id);
  }
}

/// The largest difference of a pixel's channels; infinite where one is not finite.
double difference_at(const Plane& a, const Plane& b, int x, int y) {
  double worst = 0;
  for (int c = 0; c < a.channels(); ++c) {
    const double d = std::abs(double{a.channel(c).at(x, y)} - double{b.channel(c).at(x, y)});
    worst = std::isfinite(d) ? std::max(worst, d) : HUGE_VAL;
  }
  return worst;
}

OracleErrors errors_of(const Results& floats, const Results& doubles, PlaneId id) {
  const double unit = unit_of(doubles, id), tipped = oracle_budget(id.kind).tipped;
  OracleErrors out{id};
  double pixels = 0, tips = 0, squares = 0;
  for (std::size_t frame = 0; frame < doubles.size(); ++frame) {
    const Plane &a = floats[frame].at(id), &b = doubles[frame].at(id);
    for (int y = 0; y < b.height(); ++y)
      for (int x = 0; x < b.width(); ++x) {
        const double error = difference_at(a, b, x, y) / unit;
        pixels += 1;
        if (error > tipped) {
          tips += 1;
          out.largest_tip = std::max(out.largest_tip, error);
        } else {
          squares += error * error;
          out.largest = std::max(out.largest, error);
        }
      }
  }
  out.rms = pixels > tips ? std::sqrt(squares / (pixels - tips)) : 0;
  out.tipped_share = pixels > 0 ? tips / pixels : 0;
  return out;
}

}  // namespace

// Twice to four times what is seen over all recipes, scenes, sizes and instruction sets.
const OracleBudget& oracle_budget(PlaneKind kind) {
  // Positions are floats of a hundred pixels, to 1e-5. Reflections that are drawn (`paper`) lean on
  // the image of a thousandth of the way to the eye, a difference of near equals, times 16 px. What
  // tips is which of two candidates that promise the same is followed, as where the sky is
  // reflected: their values are the same, too.
  static const OracleBudget vectors{"vectors", 1e-2, 2e-2, 5e-4};
  // Samples and weights follow from variances, which are differences of means: of what is nearly
  // constant, such as the reflection of the sky, little is left but rounding.
  static const OracleBudget history{"history", 2e-2, 1e-3, 6e-4};
  static const OracleBudget confidence{"confidence", 2e-2, 1e-3, 6e-4};
  // exp_nonpositive is off by 6e-6, and so are weights; means of 0 and 1 by less.
  static const OracleBudget visibility{"visibility", 1e-3, 1e-3, 3e-5};
  // The same, the variances above, which say how far edges are seen (`svgf`, whose moments cancel),
  // and for `paper` another draw's place on the taps.
  static const OracleBudget radiance{"radiance", 3e-3, 1e-3, 1e-4};
  // A sum of all of these, each times its factor below 1.
  static const OracleBudget composite{"composite", 1e-3, 1e-3, 2e-5};
  switch (kind) {
    case PlaneKind::kDebugMotion: return vectors;
    case PlaneKind::kDebugHistory: return history;
    case PlaneKind::kDebugConfidence: return confidence;
    case PlaneKind::kVisibility: return visibility;
    case PlaneKind::kComposite: return composite;
    default: return radiance;
  }
}

bool OracleErrors::within_budget() const {
  const OracleBudget& budget = oracle_budget(plane.kind);
  return tipped_share <= budget.share && rms <= budget.rms && std::isfinite(largest_tip);
}

Results filter_frames(DenoiserConfig config, const std::string& preset,
                      const std::vector<Frame>& frames) {
  config.preset = preset;
  config.history = "f32";  // the oracle rounds nothing
  config.debug_planes = true;
  Denoiser denoiser(config);
  Results results(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) denoiser.filter(frames[k], results[k]);
  return results;
}

Results filter_by_oracle(DenoiserConfig config, const std::string& preset,
                         const std::vector<Frame>& frames) {
  config.preset = preset;
  config.debug_planes = true;
  const Plan plan = Plan::make(config);
  oracle::FrameOracle oracle(config, plan);
  Results results(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    FrameReport report;
    StageTimer timer(report.stages);
    const bool has_past = k > 0 && !frames[k].cut && plan.history;
    oracle.filter(frames[k], has_past, results[k], report, timer);
  }
  return results;
}

std::vector<OracleErrors> oracle_errors(const Results& floats, const Results& doubles) {
  std::vector<OracleErrors> out;
  for (const Plane& plane : doubles.front()) out.push_back(errors_of(floats, doubles, plane.id()));
  return out;
}

}  // namespace holdfast::stability
