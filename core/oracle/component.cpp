#include "core/oracle/component.h"

#include <algorithm>
#include <optional>

#include "core/history/unlit.h"
#include "core/oracle/antilag.h"
#include "core/oracle/candidates.h"
#include "core/oracle/composite.h"
#include "core/oracle/dual_past.h"
#include "core/oracle/exponential.h"
#include "core/oracle/reflections.h"
#include "core/oracle/shadows.h"
#include "core/oracle/spatial.h"

namespace holdfast::oracle {
namespace {

// How narrow the window of the differences from history is, as a multiple of the precision of the
// filter's footprint.
constexpr double kVisibilityWindow = double{0.15f};
constexpr double kRadianceWindow = 3;

Image scaled(const Image& image, double factor) {
  Image out = image;
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) *= factor;
  });
  return out;
}

double mean_on_surfaces(const Surfaces& now, const Image& image) {
  double sum = 0, pixels = 0;
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    if (!now.any(x, y)) return;
    sum += image.at(x, y);
    pixels += 1;
  });
  return pixels > 0 ? sum / pixels : 0;
}

}  // namespace

/// What a frame says of the component besides its samples.
struct ComponentOracle::Input {
  std::optional<ShadowInput> shadow;
  std::optional<ReflectionInput> reflection;
};

ComponentOracle::ComponentOracle(const DenoiserConfig& config, const Plan& plan,
                                 const Plan::Entry& entry)
    : config_(config),
      plan_(plan),
      entry_(entry),
      visibility_(entry.component.kind == ComponentKind::kVisibility) {
  if (entry.cones) cones_ = std::make_unique<Cones>(plan.recipe.indirect_basis);
}

ComponentOracle::Input ComponentOracle::input_of(const Frame& frame) const {
  Input out;
  const PlaneSet& planes = frame.planes;
  const std::uint32_t id = entry_.component.light;
  if (visibility_ && entry_.has_footprint)
    out.shadow.emplace(
        ShadowInput{*std::find_if(config_.lights.begin(), config_.lights.end(),
                                  [&](const Light& light) { return light.id == id; }),
                    {},
                    planes.at(PlaneId::of_light(PlaneKind::kBlockerDistance, id)),
                    planes.at(PlaneId::of_light(PlaneKind::kLightSample, id)),
                    planes.find(PlaneId::of_light(PlaneKind::kBlockerId, id))});
  if (entry_.component.kind == ComponentKind::kGlossy &&
      (entry_.has_footprint || entry_.follows_effect))
    out.reflection.emplace(ReflectionInput{planes.at({PlaneKind::kGlossyDirection, {}}),
                                           planes.at({PlaneKind::kGlossyHitDistance, {}}),
                                           planes.find({PlaneKind::kGlossyHitId, {}})});
  return out;
}

Image ComponentOracle::field_of(const FrameView& view, const Input& input) const {
  if (!entry_.has_footprint) return {};
  return input.shadow ? shadow_field(view.now, *input.shadow)
                      : lobe_field(view.now, *input.reflection);
}

bool ComponentOracle::follows(const FrameView& view) const {
  if (!entry_.follows_effect || view.surface == nullptr) return false;
  // Where nothing moves, a reflection's relative vector is its surface's.
  const bool relative = entry_.component.kind == ComponentKind::kGlossy &&
                        plan_.recipe.glossy == GlossyVectors::kRelative;
  return !(relative && view.scene.at_rest());
}

Past ComponentOracle::effect_past(const FrameView& view, const Input& input, const Image& field,
                                  const Statistics& statistics, const FrameKey& key) const {
  if (visibility_)
    return shadow_past(view, *input.shadow, plan_.recipe.shadow == ShadowVectors::kPaper, field,
                       statistics);
  if (entry_.component.kind == ComponentKind::kIndirect) return dual_past(view);
  const GlossyRule rule = plan_.recipe.glossy == GlossyVectors::kSpecular ? GlossyRule::kSpecular
                          : plan_.recipe.glossy == GlossyVectors::kStochastic
                              ? GlossyRule::kStochastic
                              : GlossyRule::kRelative;
  return reflection_past(view, *input.reflection, rule, key);
}

ComponentOracle::Result ComponentOracle::run(const FrameView& view, const Frame& frame) {
  Result out;
  Image noisy = load_signal(frame.planes.at(component_plane(entry_.component)), out.repaired);
  Input input = input_of(frame);
  if (input.shadow) input.shadow->places = view.scene.light(entry_.component.light);
  const FrameKey key{config_.seed, frame.index};
  std::optional<Past> effect;
  if (cones_) {  // corrected along vectors that do not depend on samples
    if (follows(view)) effect = effect_past(view, input, {}, {}, key);
    cones_->correct(view, effect ? &*effect : nullptr,
                    frame.planes.at({PlaneKind::kIndirectDirection, {}}), plan_.recipe.cones,
                    noisy);
  }
  const Image field = field_of(view, input);
  const Statistics statistics = measure(view.now, noisy, field);
  if (follows(view) && !effect) effect = effect_past(view, input, field, statistics, key);

  Sources sources;
  if (plan_.history) sources.surface = view.surface;
  if (effect) sources.effect = &*effect;
  Image antilag;
  if (entry_.gradients) {
    antilag = antilag_of(view.now, frame.planes.at({PlaneKind::kGradient, entry_.component}),
                         plan_.recipe.gradient_levels, out.repaired_gradients);
    if (sources.surface != nullptr) sources.antilag = &antilag;
  }
  Blended blended = blend(view, noisy, sources, statistics);
  history_ = std::move(blended.now);
  const Image lit = lit_of(view, frame.planes);
  const auto for_each_unlit = [&](const auto& body) {
    if (lit)
      for_each_pixel(lit.width(), lit.height(), [&](int x, int y) {
        if (lit.at(x, y) == 0) body(x, y);
      });
  };
  for_each_unlit(
      [&](int x, int y) { history_.samples.at(x, y) = static_cast<double>(kUnlitSamples); });
  out.filtered = filter(view, statistics);
  for_each_unlit([&](int x, int y) {
    history_.samples.at(x, y) = 0;
    out.filtered.at(x, y) = noisy.at(x, y);
  });
  out.motion = std::move(blended.motion);
  out.frames = std::move(blended.frames);
  out.weight = std::move(blended.weight);
  out.changed_share = blended.changed_share;
  out.mean_history_frames = mean_on_surfaces(view.now, history_.samples);
  return out;
}

/// 1 where the light reaches the surface; empty: not known.
Image ComponentOracle::lit_of(const FrameView& view, const PlaneSet& planes) const {
  if (!visibility_) return {};
  const std::uint32_t id = entry_.component.light;
  const auto make = [&](const auto& value_at) {
    Image lit(view.now.width, view.now.height, 1);
    for_each_pixel(lit.width(), lit.height(), [&](int x, int y) {
      for (int c = 0; c < 3; ++c)
        if (!(value_at(x, y, c) <= 0.0)) lit.at(x, y) = 1;
    });
    return lit;
  };
  if (const Plane* given = planes.find(PlaneId::of_light(PlaneKind::kUnshadowed, id)))
    return make(
        [&](int x, int y, int c) { return static_cast<double>(given->channel(c).at(x, y)); });
  for (const Light& light : config_.lights) {
    const auto& shaded = plan_.shaded_lights;
    if (light.id != id || std::find(shaded.begin(), shaded.end(), id) == shaded.end()) continue;
    const Image own = shade(view.now, light, view.scene.light(id), plan_.shaded_lobe, planes);
    return make([&](int x, int y, int c) { return own.at(x, y, c); });
  }
  return {};
}

Blended ComponentOracle::blend(const FrameView& view, const Image& noisy, const Sources& sources,
                               const Statistics& statistics) const {
  const Recipe& recipe = plan_.recipe;
  if (recipe.blending != Blending::kExpectedError || sources.surface == nullptr) {
    AccumulationRule rule = recipe.accumulation;
    // For indirect light the surface's vector is the right one, and no fallback to be clamped.
    if (entry_.component.kind == ComponentKind::kIndirect &&
        rule.rectification == Rectification::kClampFallback)
      rule.rectification = Rectification::kNone;
    Blended out = blend_exponentially(view.now, noisy, sources, rule, history_, recipe.svgf_filter);
    if (recipe.blending == Blending::kExpectedError && !visibility_)
      out.now.residual = Image(view.now.width, view.now.height, 4);
    return out;
  }
  Image window;
  if (statistics.footprint)
    window = scaled(statistics.footprint, visibility_ ? kVisibilityWindow : kRadianceWindow);
  const Image* footprint = window ? &window : nullptr;
  if (!visibility_)
    return blend_radiance(view.now, noisy, sources, footprint,
                          entry_.component.kind == ComponentKind::kGlossy ? recipe.glossy_blend
                                                                          : recipe.indirect_blend,
                          view.scene.at_rest(), history_);
  ExpectedErrorRule rule = recipe.visibility_blend;
  // Where the light's shadows stand still, a change is one of the light.
  rule.change.noticed &=
      view.scene.geometry_at_rest() && view.scene.light(entry_.component.light).at_rest;
  return blend_visibility(view.now, noisy, sources, statistics.variance, footprint, rule, history_);
}

Image ComponentOracle::filter(const FrameView& view, const Statistics& statistics) {
  const Recipe& recipe = plan_.recipe;
  Image out =
      recipe.svgf_filter
          ? filter_by_variance(view.now, statistics, recipe.svgf_levels, history_)
          : filter_by_samples(view.now, history_, statistics,
                              visibility_ ? recipe.visibility_filter : recipe.radiance_filter);
  if (cones_)  // corrected samples may be negative, and so may what is left of few
    for_each_pixel(out.width(), out.height(), [&](int x, int y) {
      for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) = std::max(out.at(x, y, c), 0.0);
    });
  return out;
}

std::size_t ComponentOracle::bytes() const {
  return history_.signal.bytes() + history_.samples.bytes() + history_.moments.bytes() +
         history_.residual.bytes() + (cones_ ? cones_->bytes() : 0);
}

}  // namespace holdfast::oracle
