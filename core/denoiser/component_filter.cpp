#include "core/denoiser/component_filter.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/denoiser/traffic.h"
#include "core/history/dual_history.h"
#include "core/history/shadow_history.h"
#include "core/history/unlit.h"
#include "core/kernels/math.h"
#include "core/kernels/parallel.h"
#include "core/kernels/random.h"
#include "core/spatial/filter_rows.h"
#include "core/spatial/svgf_filter.h"

namespace holdfast {
namespace {

constexpr int kStatisticsStep = 3;  // 9x9 window, tiled exactly

// A window whose samples all agree still gets a variance: fewer than a hundred equal samples of a
// visibility leave it that uncertain (ours, tuned on cylinder), and radiance has no scale but its
// own.
constexpr float kVisibilityVarianceFloor = 1e-3f;
constexpr float kRelativeVarianceFloor = 1e-4f;
constexpr float kVarianceFloor = 1e-30f;

/// Samples corrected by cones may be negative, and so may what little is left of few.
void keep_positive(Plane& radiance) {
  for_each_row(radiance.height(), [&](int y) {
    for (int c = 0; c < radiance.channels(); ++c) {
      float* row = radiance.channel(c).row(y);
      for (int x = 0; x < radiance.width(); ++x) row[x] = std::max(row[x], 0.0f);
    }
  });
}

/// What the rounding of a history depends on: the frame, and whose history it is.
std::uint64_t rounding_key(const ComponentInput& input, Component component) {
  return mix_bits(static_cast<std::uint64_t>(input.key.frame)) +
         (std::uint64_t{component.light} << 8) + static_cast<std::uint64_t>(component.kind);
}

}  // namespace

ComponentFilter::ComponentFilter(const Plan& plan, const Plan::Entry& entry, int width, int height)
    : component_(entry.component),
      has_footprint_(entry.has_footprint),
      follows_effect_(entry.follows_effect),
      recipe_(plan.recipe_of(entry)),
      channels_(component_.kind == ComponentKind::kVisibility ? 1 : 3),
      extras_(plan.extras()),
      kept_(width, height, ComponentHistory(channels_, extras_).kept_as(), plan.history_format),
      sample_count_(height) {
  if (entry.cones) cones_ = ConeHistory(width, height, recipe_.indirect_basis, plan.history_format);
}

void ComponentFilter::change(Recipe&& recipe, ConeHistory* cones) noexcept {
  recipe_ = std::move(recipe);
  if (cones != nullptr) cones_ = std::move(*cones);
}

void ComponentFilter::run(const ComponentInput& input, Scratch& scratch, Plane& out) {
  std::optional<ShadowTracer> tracer;
  if (input.light != nullptr)
    tracer.emplace(input.frames.now, input.frames.scene, *input.light, input.blockers);
  if (!input.cone_samples.empty()) correct_by_cones(input, scratch);
  const bool young_alone = recipe_.svgf_filter && !has_footprint_ && !follows_effect_;
  if (!young_alone) {
    measure(input, tracer ? &*tracer : nullptr, scratch);
    input.timer.end("statistics", statistics_traffic(channels_, has_footprint_));
  }

  const bool follows = follows_effect(input);
  if (follows && !cones_) {
    trace_effect(input, tracer ? &*tracer : nullptr, scratch);
    input.timer.end("vectors", vectors_traffic());
  }
  blend(input, follows, scratch);
  const bool candidates = recipe_.blending == Blending::kExpectedError && input.surface != nullptr;
  input.timer.end("blend", blend_traffic(channels_, candidates, follows_effect_));
  if (young_alone) {
    measure_young(input, scratch);
    input.timer.end("statistics", statistics_traffic(channels_, has_footprint_));
  }
  HistoryRoom& histories = room(scratch);
  if (input.unshadowed != nullptr)
    set_unlit(*input.unshadowed, kUnlitSamples, histories.now.samples());
  filter(input, scratch, out);
  if (input.unshadowed != nullptr) {
    set_unlit(*input.unshadowed, 0.0f, histories.now.samples());
    pass_unlit(*input.unshadowed, std::as_const(scratch.noisy)[0], out.channel(0));
  }
  input.timer.end("filter", filter_traffic(channels_, recipe_, has_footprint_));
  sample_count_.measure(input.frames.now, histories.now);
  keep(input, histories);
  if (kept_.format() == HistoryFormat::kPacked)
    input.timer.end("keep", packing_traffic(histories.now.data.count()));
}

void ComponentFilter::correct_by_cones(const ComponentInput& input, Scratch& s) {
  const bool follows = follows_effect(input);
  if (follows) {
    trace_effect(input, nullptr, s);
    input.timer.end("vectors", vectors_traffic());
  }
  cones_.correct(input.frames, input.surface, follows ? &s.effect : nullptr, input.cone_samples,
                 recipe_.cones, rounding_key(input, component_) + 1, s.cones, s.window);
  if (input.quads != nullptr) {
    const Channels<float>* pixels[HalfGrid::kQuad];
    for (std::size_t k = 0; k < HalfGrid::kQuad; ++k) pixels[k] = input.cone_samples[k].radiance;
    mean_of_quads(pixels, channels_, *input.quads, s.noisy);
  }
  input.timer.end("cones", cones_traffic(recipe_));
}

bool ComponentFilter::follows_effect(const ComponentInput& input) const {
  if (!follows_effect_ || input.surface == nullptr) return false;
  // Where nothing moves, a reflection's relative vector is its surface's.
  const bool relative =
      component_.kind == ComponentKind::kGlossy && recipe_.glossy == GlossyVectors::kRelative;
  return !(relative && input.frames.scene.at_rest());
}

void ComponentFilter::trace_effect(const ComponentInput& input, const ShadowTracer* tracer,
                                   Scratch& s) const {
  switch (component_.kind) {
    case ComponentKind::kVisibility: {
      const auto rule =
          recipe_.shadow == ShadowVectors::kPaper ? ShadowRule::kPaper : ShadowRule::kBorrowed;
      const Channels<float>& means = s.means;
      trace_shadow_history(input.frames, *tracer, rule, means[kField + kFieldValid],
                           means[kField + kFieldRatio],
                           std::as_const(s.measured)[kField + kFieldRatio], s.effect);
      break;
    }
    case ComponentKind::kGlossy: {
      const auto rule = recipe_.glossy == GlossyVectors::kSpecular     ? GlossyRule::kSpecular
                        : recipe_.glossy == GlossyVectors::kStochastic ? GlossyRule::kStochastic
                                                                       : GlossyRule::kRelative;
      trace_glossy_history(input.frames, input.reflections, rule, input.key, s.effect);
      break;
    }
    case ComponentKind::kIndirect:
      trace_dual_history(input.frames, *input.surface, s.effect);
      break;
  }
}

void ComponentFilter::measure(const ComponentInput& input, const ShadowTracer* tracer,
                              Scratch& s) const {
  measure_luminance(s);
  if (tracer != nullptr)
    tracer->measure(s.measured, kField);
  else if (has_footprint_)
    measure_lobes(input.frames.now, input.reflections, s.measured, kField);
  // Where a visibility is constant and nothing blocks, so are all other channels.
  const Channels<float>& measured = s.measured;
  const ChannelView<const float> varying[2] = {
      measured[kLuminance],
      measured[has_footprint_ ? kField + (tracer != nullptr ? kFieldRatio : kFieldPrecision)
                              : kLuminance]};
  s.measured_activity.measure(input.frames.now, varying, 1 + kStatisticsStep, 0.0f);
  window_means(input.frames.now, measured, has_footprint_ ? kMeasured : kField, kStatisticsStep,
               s.window, s.means, &s.measured_activity);
  finish_statistics(s);
}

/// The variance of samples where the history that has been blended is young, as it is wherever
/// there is no surface, which surfaces beside look at; elsewhere anything.
void ComponentFilter::measure_young(const ComponentInput& input, Scratch& s) const {
  s.measured_activity.measure_below(std::as_const(room(s).now).samples(), kYoung,
                                    1 + kStatisticsStep);
  if (s.measured_activity.active_share() == 0) return;
  measure_luminance(s);
  window_means(input.frames.now, s.measured, kField, kStatisticsStep, s.window, s.means,
               &s.measured_activity);
  finish_statistics(s);
}

/// The luminance of the samples, and its square.
void ComponentFilter::measure_luminance(Scratch& s) const {
  const int last = channels_ - 1;
  for_each_row(s.noisy.height(), [&](int y) {
    luminance_row({{s.noisy[0].row(y), s.noisy[last / 2].row(y), s.noisy[last].row(y)},
                   channels_,
                   s.noisy.width(),
                   s.measured[kLuminance].row(y),
                   s.measured[kSquare].row(y)});
  });
}

/// From means to variance and footprint.
void ComponentFilter::finish_statistics(Scratch& s) const {
  const bool visibility = channels_ == 1;
  for_each_row(s.noisy.height(), [&](int y) {
    StatisticsRow row{};
    row.mean = s.means[kLuminance].row(y);
    row.square = s.means[kSquare].row(y);
    row.variance = s.means[kSquare].row(y);
    row.floor_share = visibility ? 0.0f : kRelativeVarianceFloor;
    row.floor_0 = visibility ? kVisibilityVarianceFloor : kVarianceFloor;
    row.width = s.noisy.width();
    if (has_footprint_) {
      row.valid = s.means[kField + kFieldValid].row(y);
      for (int c = 0; c < 3; ++c) {
        row.precision[c] = s.means[kField + kFieldPrecision + c].row(y);
        row.footprint[c] = s.footprint[c].row(y);
      }
    }
    statistics_row(row);
  });
}

void ComponentFilter::blend(const ComponentInput& input, bool follows, Scratch& s) {
  HistorySources sources;
  if (recipe_.blending != Blending::kNoHistory) sources.surface = input.surface;
  if (follows) sources.effect = &s.effect;
  sources.effect_stands_in = component_.kind == ComponentKind::kIndirect;
  if (input.gradients && sources.surface != nullptr)
    sources.antilag = antilag_of_gradients(input.frames.now, recipe_.gradient_levels, s.gradients);
  HistoryRoom& histories = room(s);
  kept_.recall(histories.before.data);
  if (kept_.format() == HistoryFormat::kPacked)
    input.timer.end("recall", packing_traffic(histories.now.data.count()));
  const ComponentHistory& before = histories.before;
  ComponentHistory& now = histories.now;
  Channels<float>* debug = s.debug ? &s.debug : nullptr;
  changed_share_ = 0;
  if (recipe_.blending == Blending::kExpectedError && sources.surface != nullptr) {
    const Channels<float>* footprint = has_footprint_ ? &s.footprint : nullptr;
    if (channels_ == 1) {
      ExpectedErrorRule rule = recipe_.visibility_blend;
      rule.change.noticed &= shadows_at_rest(input);
      blend_by_expected_error(input.frames.now, s.noisy, sources,
                              std::as_const(s.means)[kSampleVariance], footprint, rule, before,
                              s.blend, s.window, now, debug);
      changed_share_ = s.blend.change.share();
    } else {
      blend_radiance(
          input.frames.now, s.noisy, sources, footprint,
          component_.kind == ComponentKind::kGlossy ? recipe_.glossy_blend : recipe_.indirect_blend,
          input.frames.scene.at_rest(), before, s.radiance_blend, s.window, now, debug);
      changed_share_ = s.radiance_blend.change[0].share();
    }
  } else {
    AccumulationRule rule = recipe_.accumulation;
    // For indirect light the surface's vector is the right one, and no fallback to be clamped.
    if (component_.kind == ComponentKind::kIndirect &&
        rule.rectification == Rectification::kClampFallback)
      rule.rectification = Rectification::kNone;
    accumulate(input.frames.now, s.noisy, sources, rule, before, now,
               recipe_.svgf_filter ? s.filter.odd : now.data, debug);
  }
}

/// Whatever else moves, the shadows of this light stand still: a change is one of the light.
bool ComponentFilter::shadows_at_rest(const ComponentInput& input) const {
  const SceneMotion& scene = input.frames.scene;
  return scene.geometry_at_rest() && scene.light(component_.light).at_rest;
}

void ComponentFilter::filter(const ComponentInput& input, Scratch& s, Plane& out) {
  ComponentHistory& now = room(s).now;
  const Signal signal{recipe_.svgf_filter ? &s.filter.odd : &now.data, channels_,
                      std::as_const(now).samples(), std::as_const(s.means)[kSampleVariance],
                      has_footprint_ ? &s.footprint : nullptr};
  if (recipe_.svgf_filter) {
    const ComponentHistory& moments = now;
    svgf_filter(input.frames.now, signal, moments.moment(1), moments.moment(2), recipe_.svgf_levels,
                s.filter, now.data, out);
  } else {
    adaptive_filter(input.frames.now, signal,
                    channels_ == 1 ? recipe_.visibility_filter : recipe_.radiance_filter,
                    s.window.weights, s.filter, out);
  }
  if (cones_) keep_positive(out);
}

void ComponentFilter::keep(const ComponentInput& input, HistoryRoom& histories) {
  kept_.keep(histories.now.data, rounding_key(input, component_));
  // Floats have changed places with their room: what was theirs is the next frame's room.
  if (!histories.now.data) std::swap(histories.now.data, histories.before.data);
}

ComponentHistory ComponentFilter::kept() const {
  ComponentHistory history(channels_, extras_);
  history.data = kept_.copy();
  return history;
}

}  // namespace holdfast
