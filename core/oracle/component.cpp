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

Image image_of(const Plane& plane) {
  Image out(plane.width(), plane.height(), plane.channels());
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) = double{plane.channel(c).at(x, y)};
  });
  return out;
}

/// Each pixel of half size four times, `factor` times as large.
Image repeated(const Image& half, const Surfaces& full, double factor) {
  Image out(full.width, full.height, half.channels());
  for_each_pixel(full.width, full.height, [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) = factor * half.at(x / 2, y / 2, c);
  });
  return out;
}

template <class Body>
void for_each_unlit(const Image& lit, const Body& body) {
  for_each_pixel(lit.width(), lit.height(), [&](int x, int y) {
    if (lit.at(x, y) == 0) body(x, y);
  });
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
      recipe_(plan.recipe_of(entry)),
      entry_(entry),
      visibility_(entry.component.kind == ComponentKind::kVisibility) {
  if (entry.cones) cones_ = std::make_unique<Cones>(recipe_.indirect_basis);
}

ComponentOracle::Input ComponentOracle::input_of(const PlaneSet& planes) const {
  Input out;
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
  const bool relative =
      entry_.component.kind == ComponentKind::kGlossy && recipe_.glossy == GlossyVectors::kRelative;
  return !(relative && view.scene.at_rest());
}

Past ComponentOracle::effect_past(const FrameView& view, const Input& input, const Image& field,
                                  const Statistics& statistics, const FrameKey& key) const {
  if (visibility_)
    return shadow_past(view, *input.shadow, recipe_.shadow == ShadowVectors::kPaper, field,
                       statistics);
  if (entry_.component.kind == ComponentKind::kIndirect) return dual_past(view);
  const GlossyRule rule = recipe_.glossy == GlossyVectors::kSpecular     ? GlossyRule::kSpecular
                          : recipe_.glossy == GlossyVectors::kStochastic ? GlossyRule::kStochastic
                                                                         : GlossyRule::kRelative;
  return reflection_past(view, *input.reflection, rule, key);
}

ComponentOracle::Result ComponentOracle::run(const FrameView& view, const Frame& frame) {
  Result out;
  Samples samples(1);
  samples[0].radiance =
      load_signal(frame.planes.at(component_plane(entry_.component)), out.repaired);
  if (cones_) samples[0].direction = image_of(frame.planes.at({PlaneKind::kIndirectDirection, {}}));
  Image antilag;
  if (entry_.gradients)
    antilag = antilag_of(view.now, frame.planes.at({PlaneKind::kGradient, entry_.component}),
                         recipe_.gradient_levels, out.repaired_gradients);
  run_chain(view, frame.planes, {config_.seed, frame.index}, samples, nullptr,
            lit_of(view, frame.planes), entry_.gradients ? &antilag : nullptr, out);
  return out;
}

ComponentOracle::Result ComponentOracle::run_halved(const HalfFrame& half, const FrameView& full,
                                                    const Frame& frame) {
  Result out;
  const Image noisy = load_signal(frame.planes.at(component_plane(entry_.component)), out.repaired);
  Image directions;
  if (cones_) directions = image_of(frame.planes.at({PlaneKind::kIndirectDirection, {}}));
  Samples samples;
  for (int k = 0; k < Quads::kPixels; ++k) {
    DirectedSamples& pixel = samples.emplace_back();
    pixel.radiance = pixel_of_quads(noisy, half.quads(), k);
    if (cones_) pixel.direction = pixel_of_quads(directions, half.quads(), k);
  }
  const FrameView view = half.view();
  const Image lit = lit_of(full, frame.planes);
  run_chain(view, half.planes(), {config_.seed, frame.index}, samples, &half.quads(),
            representatives(lit, half.quads()), nullptr, out);
  out.filtered = upsample(full.now, view.now, out.filtered, noisy);
  for_each_unlit(lit, [&](int x, int y) { out.filtered.at(x, y) = noisy.at(x, y); });
  out.motion = repeated(out.motion, full.now, 2);
  out.frames = repeated(out.frames, full.now, 1);
  out.weight = repeated(out.weight, full.now, 1);
  return out;
}

void ComponentOracle::run_chain(const FrameView& view, const PlaneSet& planes, const FrameKey& key,
                                Samples& samples, const Quads* quads, const Image& lit,
                                const Image* antilag, Result& out) {
  Input input = input_of(planes);
  if (input.shadow) input.shadow->places = view.scene.light(entry_.component.light);
  std::optional<Past> effect;
  if (cones_) {  // corrected along vectors that do not depend on samples
    if (follows(view)) effect = effect_past(view, input, {}, {}, key);
    cones_->correct(view, effect ? &*effect : nullptr, samples, recipe_.cones);
  }
  const Image noisy = quads != nullptr ? mean_of_quads(samples, *quads) : samples[0].radiance;
  const Image field = field_of(view, input);
  const Statistics statistics = measure(view.now, noisy, field);
  if (follows(view) && !effect) effect = effect_past(view, input, field, statistics, key);

  Sources sources;
  if (plan_.history) sources.surface = view.surface;
  if (effect) sources.effect = &*effect;
  if (sources.surface != nullptr) sources.antilag = antilag;
  Blended blended = blend(view, noisy, sources, statistics);
  history_ = std::move(blended.now);
  out.filtered = filter_lit(view, lit, noisy, statistics);
  out.motion = std::move(blended.motion);
  out.frames = std::move(blended.frames);
  out.weight = std::move(blended.weight);
  out.changed_share = blended.changed_share;
  out.mean_history_frames = mean_on_surfaces(view.now, history_.samples);
}

/// Filters the history. Where a light sends nothing, its visibility is passed through, and says
/// next to nothing to its neighbours and nothing to later frames.
Image ComponentOracle::filter_lit(const FrameView& view, const Image& lit, const Image& noisy,
                                  const Statistics& statistics) {
  for_each_unlit(lit, [&](int x, int y) { history_.samples.at(x, y) = double{kUnlitSamples}; });
  Image out = filter(view, statistics);
  for_each_unlit(lit, [&](int x, int y) {
    history_.samples.at(x, y) = 0;
    out.at(x, y) = noisy.at(x, y);
  });
  return out;
}

/// 1 where the light reaches the surface; empty: not known.
Image ComponentOracle::lit_of(const FrameView& view, const PlaneSet& planes) const {
  if (!entry_.leaves_out_unlit) return {};
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
  if (recipe_.blending != Blending::kExpectedError || sources.surface == nullptr) {
    AccumulationRule rule = recipe_.accumulation;
    // For indirect light the surface's vector is the right one, and no fallback to be clamped.
    if (entry_.component.kind == ComponentKind::kIndirect &&
        rule.rectification == Rectification::kClampFallback)
      rule.rectification = Rectification::kNone;
    return blend_exponentially(view.now, noisy, sources, rule, history_, recipe_.svgf_filter);
  }
  const Image* footprint = statistics.footprint ? &statistics.footprint : nullptr;
  if (!visibility_)
    return blend_radiance(view.now, noisy, sources, footprint,
                          entry_.component.kind == ComponentKind::kGlossy ? recipe_.glossy_blend
                                                                          : recipe_.indirect_blend,
                          view.scene.at_rest(), history_);
  ExpectedErrorRule rule = recipe_.visibility_blend;
  // Where the light's shadows stand still, a change is one of the light.
  rule.change.noticed &=
      view.scene.geometry_at_rest() && view.scene.light(entry_.component.light).at_rest;
  return blend_visibility(view.now, noisy, sources, statistics.variance, footprint, rule, history_);
}

Image ComponentOracle::filter(const FrameView& view, const Statistics& statistics) {
  Image out =
      recipe_.svgf_filter
          ? filter_by_variance(view.now, statistics, recipe_.svgf_levels, history_)
          : filter_by_samples(view.now, history_, statistics,
                              visibility_ ? recipe_.visibility_filter : recipe_.radiance_filter);
  if (cones_)  // corrected samples may be negative, and so may what is left of few
    for_each_pixel(out.width(), out.height(), [&](int x, int y) {
      for (int c = 0; c < out.channels(); ++c) out.at(x, y, c) = std::max(out.at(x, y, c), 0.0);
    });
  return out;
}

std::size_t ComponentOracle::bytes() const {
  return history_.signal.bytes() + history_.samples.bytes() + history_.moments.bytes() +
         (cones_ ? cones_->bytes() : 0);
}

}  // namespace holdfast::oracle
