#include "client/measure/claims.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/measure/reference_noise.h"

namespace holdfast::measure {
namespace {

constexpr const char* kOurs = "reliable";
constexpr double kStillTolerance = 0.01;
constexpr double kTolerance = 0.005;

struct Bar {
  const char* against;
  Relation relation;
  double rmse;
};

/// An effect, the scenes that show it alone, and by how much `reliable` must win there.
struct EffectClaims {
  const char* effect;
  PlaneKind kind;
  std::vector<std::string> scenes;
  std::array<Bar, 3> bars;
};

const std::vector<EffectClaims>& effect_claims() {
  static const std::vector<EffectClaims> claims{{"shadows",
                                                 PlaneKind::kVisibility,
                                                 {"fence", "cylinder"},
                                                 {{{"clamp", Relation::kAtMost, 0.84},
                                                   {"svgf", Relation::kAtMost, 0.60},
                                                   {"asvgf", Relation::kBelow, 1.0}}}},
                                                {"glossy",
                                                 PlaneKind::kGlossy,
                                                 {"glossy-floor"},
                                                 {{{"specular", Relation::kAtMost, 0.98},
                                                   {"asvgf", Relation::kAtMost, 0.54},
                                                   {"clamp", Relation::kAtMost, 0.50}}}},
                                                {"occlusion",
                                                 PlaneKind::kIndirect,
                                                 {"occluder"},
                                                 {{{"clamp", Relation::kAtMost, 0.98},
                                                   {"svgf", Relation::kAtMost, 0.91},
                                                   {"traditional", Relation::kAtMost, 0.29}}}}};
  return claims;
}

double value_of(const LayerErrors& errors, Metric metric) {
  return metric == Metric::kRmse ? errors.rmse : errors.ssim;
}

/// Ours over theirs. An SSIM of 0 or less has no ratio: 1 stands for no worse, 0 for worse.
double ratio(double ours, double theirs, Metric metric) {
  if (ours == theirs) return 1.0;
  if (metric == Metric::kSsim && theirs <= 0 && !std::isnan(ours)) return ours > theirs ? 1.0 : 0.0;
  return ours / theirs;
}

Outcome outcome_of(double value, Relation relation, double bar) {
  if (std::isnan(value)) return Outcome::kNotRun;
  const bool holds = relation == Relation::kAtMost  ? value <= bar
                     : relation == Relation::kBelow ? value < bar
                                                    : value >= bar;
  return holds ? Outcome::kHolds : Outcome::kFails;
}

/// The claims of one layer of one scene.
class LayerClaims {
 public:
  LayerClaims(const ReportScene& scene, std::size_t layer, std::vector<Claim>& claims)
      : scene_(scene), layer_(layer), claims_(claims) {}

  const std::string& name() const { return layer_of(scene_.results.front()).name; }
  PlaneKind kind() const { return plane_from_name(name())->kind; }

  void effect(const EffectClaims& rule) {
    for (const Bar& bar : rule.bars)
      add(rule.effect, Region::kEffect, Metric::kRmse, bar.against, bar.relation, bar.rmse);
    add(rule.effect, Region::kEffect, Metric::kSsim, kAllOthers, Relation::kAtLeast, 1.0);
  }

  /// Never worse than `against` by more than `tolerance`.
  void no_worse(const char* effect, Region region, const char* against, double tolerance) {
    add(effect, region, Metric::kRmse, against, Relation::kAtMost, 1 + tolerance);
    add(effect, region, Metric::kSsim, against, Relation::kAtLeast, 1 - tolerance);
  }

 private:
  const Comparison::Layer& layer_of(const ReportResult& result) const {
    return result.comparison.layers[layer_];
  }

  /// The metric of one result; NaN if it was not run.
  double metric_of(const std::string& result, Region region, Metric metric) const {
    for (const ReportResult& candidate : scene_.results)
      if (candidate.name == result) return value_of(errors_of(layer_of(candidate), region), metric);
    return std::nan("");
  }

  double best_other_ssim(Region region) const {
    double best = std::nan("");
    for (const ReportResult& result : scene_.results)
      if (result.name != kOurs && !result.name.starts_with(std::string(kOurs) + "-"))
        best = std::fmax(best, errors_of(layer_of(result), region).ssim);
    return best;
  }

  void add(const char* effect, Region region, Metric metric, const char* against, Relation relation,
           double bar) {
    if (errors_of(layer_of(scene_.results.front()), region).judged_pixels == 0) return;
    const double theirs = against == std::string(kAllOthers) ? best_other_ssim(region)
                                                             : metric_of(against, region, metric);
    Claim claim{effect, scene_.name, name(), region, metric, against};
    claim.value = ratio(metric_of(kOurs, region, metric), theirs, metric);
    claim.relation = relation;
    claim.bar = bar;
    claim.outcome = outcome_of(claim.value, relation, bar);
    const auto references = check_references(scene_, name(), region);
    claim.reference_limited =
        claim.outcome != Outcome::kNotRun && references && !references->sufficient;
    claims_.push_back(std::move(claim));
  }

  const ReportScene& scene_;
  const std::size_t layer_;
  std::vector<Claim>& claims_;
};

void add_scene(const ReportScene& scene, std::vector<Claim>& claims) {
  for (std::size_t i = 0; i < scene.results.front().comparison.layers.size(); ++i) {
    LayerClaims layer(scene, i, claims);
    if (layer.kind() == PlaneKind::kComposite) continue;
    for (const EffectClaims& rule : effect_claims())
      if (rule.kind == layer.kind() &&
          std::find(rule.scenes.begin(), rule.scenes.end(), scene.name) != rule.scenes.end())
        layer.effect(rule);
    if (scene.name == "static")
      layer.no_worse("still scene", Region::kImage, "svgf", kStillTolerance);
    for (const Region region : {Region::kImage, Region::kEffect})
      for (const char* against : {"spatial", "clamp", "paper"})
        layer.no_worse(kEverywhere, region, against, kTolerance);
  }
}

}  // namespace

std::vector<Claim> evaluate_claims(const std::vector<ReportScene>& scenes) {
  std::vector<Claim> claims;
  for (const ReportScene& scene : scenes) add_scene(scene, claims);
  std::stable_partition(claims.begin(), claims.end(),
                        [](const Claim& claim) { return claim.effect != kEverywhere; });
  return claims;
}

}  // namespace holdfast::measure
