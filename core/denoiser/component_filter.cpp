#include "core/denoiser/component_filter.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "core/denoiser/traffic.h"
#include "core/kernels/parallel.h"
#include "core/spatial/filter_rows.h"
#include "core/spatial/svgf_filter.h"

namespace holdfast {
namespace {

// Channels of Scratch::measured and Scratch::means.
constexpr int kLuminance = 0;
constexpr int kSquare = 1;
constexpr int kSampleVariance = kSquare;  // of the means, once they are final
constexpr int kField = 2;                 // the channels of a shadow field
constexpr int kMeasured = kField + int{kShadowFieldChannels};

constexpr int kStatisticsStep = 3;  // 9x9 window, tiled exactly

// A window whose samples all agree still gets a variance: fewer than a hundred equal samples of a
// visibility leave it that uncertain (ours, tuned on cylinder), and radiance has no scale but its
// own.
constexpr float kVisibilityVarianceFloor = 1e-3f;
constexpr float kRelativeVarianceFloor = 1e-4f;
constexpr float kVarianceFloor = 1e-20f;

}  // namespace

Scratch::Scratch(int width, int height, bool any_radiance, bool any_shadow, bool with_blend,
                 bool with_debug)
    : noisy(width, height, any_radiance ? 3 : 1),
      measured(width, height, any_shadow ? kMeasured : kField),
      means(width, height, any_shadow ? kMeasured : kField),
      measured_activity(width, height),
      window(width, height),
      filter(width, height) {
  if (any_shadow) {
    footprint = Channels<float>(width, height, 3);
    shadow = ShadowHistory(width, height);
  }
  if (with_blend) blend = BlendScratch(width, height);
  if (with_debug) debug = Channels<float>(width, height, kDebugChannels);
}

std::size_t Scratch::bytes() const {
  return noisy.bytes() + measured.bytes() + means.bytes() + footprint.bytes() +
         shadow.taps.bytes() + shadow.motion.bytes() + window.between.bytes() +
         window.spread.bytes() + blend.bytes() + filter.bytes() + debug.bytes();
}

ComponentFilter::ComponentFilter(Component component, const Recipe& recipe, int width, int height)
    : component_(component),
      recipe_(recipe),
      channels_(component.kind == ComponentKind::kVisibility ? 1 : 3),
      row_samples_(static_cast<std::size_t>(height)),
      row_pixels_(static_cast<std::size_t>(height)) {
  for (auto& history : history_)
    history = ComponentHistory(width, height, channels_, recipe.svgf_filter);
}

void ComponentFilter::run(const ComponentInput& input, Scratch& scratch, Plane& out) {
  now_ = 1 - now_;
  std::optional<ShadowTracer> tracer;
  if (input.light != nullptr)
    tracer.emplace(input.frames.now, input.frames.scene, *input.light, input.blockers);
  measure(input, tracer ? &*tracer : nullptr, scratch);
  input.timer.end("statistics", statistics_traffic(channels_, tracer.has_value()));

  const bool with_shadow = tracer && input.surface != nullptr && uses_shadow_vectors();
  if (with_shadow) {
    const auto rule = recipe_.vectors == HistoryVectors::kPaperShadow ? ShadowRule::kPaper
                                                                      : ShadowRule::kBorrowed;
    const Channels<float>& means = scratch.means;
    trace_shadow_history(input.frames, *tracer, rule, means[kField + kShadowValid],
                         means[kField + kShadowRatio],
                         std::as_const(scratch.measured)[kField + kShadowRatio], scratch.shadow);
    input.timer.end("vectors", vectors_traffic());
  }
  blend(input, with_shadow, scratch);
  const bool candidates =
      recipe_.vectors == HistoryVectors::kCandidates && input.surface != nullptr;
  input.timer.end("blend", blend_traffic(channels_, candidates));
  filter(input, tracer.has_value(), scratch, out);
  input.timer.end("filter", filter_traffic(channels_, recipe_, tracer.has_value()));
  count_history(input.frames.now);
}

void ComponentFilter::measure(const ComponentInput& input, const ShadowTracer* tracer,
                              Scratch& s) const {
  const int width = input.frames.now.view.width, height = input.frames.now.view.height;
  const int last = channels_ - 1;
  for_each_row(height, [&](int y) {
    luminance_row({{s.noisy[0].row(y), s.noisy[last / 2].row(y), s.noisy[last].row(y)},
                   channels_,
                   width,
                   s.measured[kLuminance].row(y),
                   s.measured[kSquare].row(y)});
  });
  if (tracer != nullptr) tracer->measure(s.measured, kField);
  // Where a visibility is constant and nothing blocks, so are all other channels.
  const Channels<float>& measured = s.measured;
  const ChannelView<const float> varying[2] = {
      measured[kLuminance], measured[tracer != nullptr ? kField + kShadowRatio : kLuminance]};
  s.measured_activity.measure(input.frames.now, varying, 1 + kStatisticsStep, 0.0f);
  window_means(input.frames.now, measured, tracer != nullptr ? kMeasured : kField, kStatisticsStep,
               s.window, s.means, &s.measured_activity);
  const bool visibility = channels_ == 1;
  for_each_row(height, [&](int y) {
    StatisticsRow row{};
    row.mean = s.means[kLuminance].row(y);
    row.square = s.means[kSquare].row(y);
    row.variance = s.means[kSquare].row(y);
    row.floor_share = visibility ? 0.0f : kRelativeVarianceFloor;
    row.floor_0 = visibility ? kVisibilityVarianceFloor : kVarianceFloor;
    row.width = width;
    if (tracer != nullptr) {
      row.valid = s.means[kField + kShadowValid].row(y);
      for (int c = 0; c < 3; ++c) {
        row.precision[c] = s.means[kField + kShadowPrecision + c].row(y);
        row.footprint[c] = s.footprint[c].row(y);
      }
    }
    statistics_row(row);
  });
}

void ComponentFilter::blend(const ComponentInput& input, bool with_shadow, Scratch& s) {
  const HistorySources sources{recipe_.vectors == HistoryVectors::kNone ? nullptr : input.surface,
                               with_shadow ? &s.shadow : nullptr};
  const ComponentHistory& before = history_[1 - now_];
  ComponentHistory& now = history_[now_];
  Channels<float>* debug = s.debug ? &s.debug : nullptr;
  if (recipe_.vectors == HistoryVectors::kCandidates && sources.surface != nullptr) {
    const ExpectedErrorRule& rule =
        channels_ == 1 ? recipe_.visibility_blend : recipe_.radiance_blend;
    blend_by_expected_error(input.frames.now, s.noisy, sources,
                            std::as_const(s.means)[kSampleVariance], rule, before, s.blend,
                            s.window, now, debug);
  } else {
    accumulate(input.frames.now, s.noisy, sources, recipe_.accumulation, before, now, debug);
  }
}

void ComponentFilter::filter(const ComponentInput& input, bool with_footprint, Scratch& s,
                             Plane& out) {
  ComponentHistory& now = history_[now_];
  const Signal signal{&now.data, channels_, std::as_const(now).samples(),
                      std::as_const(s.means)[kSampleVariance],
                      with_footprint ? &s.footprint : nullptr};
  if (recipe_.svgf_filter) {
    const ComponentHistory& moments = now;
    svgf_filter(input.frames.now, signal, moments.moment(1), moments.moment(2), recipe_.svgf_levels,
                s.filter, now.data, out);
  } else {
    adaptive_filter(input.frames.now, signal,
                    channels_ == 1 ? recipe_.visibility_filter : recipe_.radiance_filter, s.filter,
                    out);
  }
}

void ComponentFilter::count_history(const Guides& now) {
  const ComponentHistory& history = history_[now_];
  for_each_row(now.view.height, [&](int y) {
    double samples = 0, pixels = 0;
    for (int x = 0; x < now.view.width; ++x) {
      if (!(now.depth().at(x, y) > 0.0f)) continue;
      samples += static_cast<double>(history.samples().at(x, y));
      pixels += 1;
    }
    row_samples_[static_cast<std::size_t>(y)] = samples;
    row_pixels_[static_cast<std::size_t>(y)] = pixels;
  });
  const double pixels = std::accumulate(row_pixels_.begin(), row_pixels_.end(), 0.0);
  const double samples = std::accumulate(row_samples_.begin(), row_samples_.end(), 0.0);
  mean_history_frames_ = pixels > 0 ? samples / pixels : 0;
}

}  // namespace holdfast
