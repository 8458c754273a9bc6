#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/denoiser/component_filter.h"
#include "core/denoiser/composite.h"
#include "core/denoiser/debug_planes.h"
#include "core/denoiser/denoiser.h"
#include "core/denoiser/frame_check.h"
#include "core/denoiser/frame_filter.h"
#include "core/denoiser/frame_input.h"
#include "core/denoiser/half_frame.h"
#include "core/denoiser/light_shading.h"
#include "core/denoiser/plan.h"
#include "core/denoiser/rest.h"
#include "core/denoiser/stage_timer.h"
#include "core/denoiser/switch_plan.h"
#include "core/denoiser/take_over.h"
#include "core/denoiser/traffic.h"
#include "core/frame/error.h"
#include "core/frame/lent_images.h"
#include "core/history/guide_pair.h"
#include "core/history/unlit.h"
#include "core/kernels/isa.h"
#include "core/kernels/parallel.h"

namespace holdfast {

/// One frame of a session, from planes to planes: the order of its steps, and what it leaves for
/// the next. Only for denoiser.cpp, which is its door.
class Denoiser::Impl {
 public:
  Impl(const DenoiserConfig& c, std::shared_ptr<ScratchPool> from)
      : config(c), plan(Plan::make(c)), pool(std::move(from)) {
    if (!pool) pool = std::make_shared<ScratchPool>();
    announced = result_planes(c);
    if (plan.preset.oracle)
      oracle = make_oracle(config, plan);
    else
      make_images(c);
    need = image_bytes().lent;
    images = pool->enter(need);
  }
  ~Impl() { pool->leave(need); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void make_images(const DenoiserConfig& c) {
    constexpr auto kLent = Memory::kLent;
    scratch = Scratch(c.width, c.height, plan, plan.full, c.debug_planes);
    selected_isa();  // reports a bad HOLDFAST_ISA here rather than in a kernel
    guides = GuidePair(c.width, c.height, plan.roughness, plan.motion, plan.history_format);
    if (plan.any_gradients) scratch.gradients = GradientScratch(c.width, c.height, kLent);
    if (plan.history && plan.full.any) surface = SurfaceHistory(c.width, c.height, kLent);
    if (plan.half.any) half = HalfFrame(c, plan);
    for (const std::uint32_t light : plan.shaded_lights)
      shaded.add(PlaneId::of_light(PlaneKind::kUnshadowed, light), c.width, c.height, kLent);
    for (const Plan::Entry& entry : plan.components) {
      filters.emplace_back(plan, entry, entry.half ? half_size(c.width) : c.width,
                           entry.half ? half_size(c.height) : c.height);
      signals.push_back(component_plane(entry.component));
    }
    rest = RestTurns(c, plan);
  }

  void go_on_from(const Impl& before) {
    scene = before.scene;
    scene.resize(config.width, config.height);
    last_index = before.last_index;
    has_past = before.has_past && plan.history && before.plan.history && !oracle && !before.oracle;
    if (!has_past) return;
    Guides last = guides.blank();
    last.view = scene.view();
    last.rays = last.view.rays.cast<float>();
    const Guides last_before = before.guides.last();
    take_over({before.plan, last_before, before.half, before.filters}, {plan, last, half, filters});
    guides.set_last(std::move(last));
  }

  FrameReport filter(const Frame& frame, PlaneSet& results) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    if (frame.index <= last_index)
      throw InputError("frame index", "must be greater than " + std::to_string(last_index),
                       std::to_string(frame.index));
    check_frame_planes(config, frame.planes);
    scene.advance(frame, config.width, config.height, config.lights);  // the last that can throw

    FrameReport report;
    StageTimer timer(report.stages);
    report.index = last_index = frame.index;
    has_past = has_past && !frame.cut && plan.history;
    report.history_reset = !has_past;
    if (next_plan) follow_next_plan(timer);
    report.preset = config.preset;
    if (oracle) {
      for (const PlaneId id : announced) results.add(id, config.width, config.height);
      oracle->filter(frame, has_past, results, report, timer);
    } else {
      const Lending lending(*this);
      run_kernels(frame, results, report, timer);
    }
    has_past = true;
    report.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return report;
  }

  /// Lends memory of the pool to all images that have none, for as long as this lives.
  struct Lending {
    explicit Lending(Impl& d) : denoiser(d), loan(d.pool->borrow(d.need, d.images)) {
      each_image(denoiser, LendImages{loan.data(), loan.is_as_left()});
    }
    ~Lending() { each_image(denoiser, TakeBackImages{}); }
    Impl& denoiser;
    const ScratchPool::Loan loan;
  };

  void run_kernels(const Frame& frame, PlaneSet& results, FrameReport& report, StageTimer& timer) {
    guides.advance(has_past);
    load_guides(frame, report);
    guides.keep();
    scratch.window.weights.clear();
    timer.end("guides", guides_traffic(plan.history_format == HistoryFormat::kPacked));
    rest.begin_frame(frame, guides.now(), guides.previous(), scene, has_past);
    follow_surfaces(frame, timer);
    if (!plan.shaded_lights.empty()) {
      shade_lights(guides.now(), scene, config.lights, plan, frame.planes, shaded);
      timer.end("unshadowed", 13 + 3 * static_cast<int>(plan.shaded_lights.size()));
    }
    for (const PlaneId id : announced) results.add(id, config.width, config.height);
    for (std::size_t k = 0; k < filters.size(); ++k) {
      timer.enter(component_name(filters[k].component()));
      if (!pass_over(frame, k, results, report, timer))
        run_component(frame, k, results, report, timer);
    }
    timer.enter("");
    report.non_finite_out = compose(guides.now(), signals, frame.planes, shaded, results);
    timer.end("composite", composite_channels(frame.planes));
  }

  void set_preset(const std::string& preset) {
    DenoiserConfig other = config;
    other.preset = preset;
    Plan next = Plan::make(other);
    if (preset != config.preset && (next.preset.oracle || plan.preset.oracle))
      throw InputError("change of preset", "must not be to or from reference",
                       "'" + config.preset + "' to '" + preset + "'");
    next_plan.reset();
    if (preset != config.preset) next_plan = std::move(next);
  }

  void follow_next_plan(StageTimer& timer) {
    std::string preset = next_plan->preset.name;
    RestTurns next_rest(config, *next_plan);
    switch_plan(config, *next_plan, has_past, {plan, guides, scratch, surface, half, filters});
    rest = std::move(next_rest);
    config.preset = std::move(preset);
    next_plan.reset();
    const std::size_t needed_before = std::exchange(need, image_bytes().lent);
    images = pool->enter(need);
    pool->leave(needed_before);
    timer.end("preset", 0);
  }

  void load_guides(const Frame& frame, FrameReport& report) {
    Guides& out = guides.now();
    out.view = scene.view();
    out.rays = out.view.rays.cast<float>();
    const PlaneId depth{PlaneKind::kDepth, {}}, normal{PlaneKind::kNormal, {}};
    count_repairs(report, depth, load_depth(frame.planes.at(depth), out));
    count_repairs(report, normal, load_normals(frame.planes.at(normal), out));
    load_ids(frame.planes.find({PlaneKind::kObjectId, {}}), out.id);
    const PlaneId roughness{PlaneKind::kRoughness, {}};
    if (plan.roughness)
      count_repairs(report, roughness, load_roughness(frame.planes.at(roughness), out));
    if (plan.motion) load_motion(frame.planes.at({PlaneKind::kMotion, {}}), out);
  }

  /// What components that are filtered in this frame follow: of each resolution that has one.
  void follow_surfaces(const Frame& frame, StageTimer& timer) {
    followed_full = followed_half = false;
    for (std::size_t k = 0; k < filters.size(); ++k)
      if (!rest.may_pass(k)) follow_surfaces(frame, plan.components[k].half, timer);
    if (plan.half.any && !followed_half) half.find_quads(guides.now());
  }

  /// Likewise of one resolution, unless that was done.
  void follow_surfaces(const Frame& frame, bool halved, StageTimer& timer) {
    if (halved && !followed_half) {
      half.advance(guides.now(), scene, frame.planes, has_past);
      timer.end("half", 24);
      followed_half = true;
    }
    if (!halved && !followed_full && has_past) {
      const FramePair frames{guides.now(), guides.previous(), scene};
      trace_surface_history(frames, frame.planes.find({PlaneKind::kMotion, {}}), surface);
      timer.end("surface", 17);
      followed_full = true;
    }
  }

  /// Returns the last result of a component at rest once more, unless it is to be filtered.
  bool pass_over(const Frame& frame, std::size_t k, PlaneSet& results, FrameReport& report,
                 StageTimer& timer) {
    const Plan::Entry& entry = plan.components[k];
    const PlaneId id = signals[k];
    count_repairs(report, id, load_signal(frame.planes.at(id), scratch.noisy));
    timer.end("input", 2 * scratch.noisy.count());
    if (!rest.watches(k)) return false;
    const Plane* unshadowed = unshadowed_of(frame, entry);
    const int channels = channel_count(id.kind);
    if (entry.half) half.take_signal(scratch.noisy, channels);
    const bool holds =
        rest.holds(k,
                   {entry.half ? half.guides() : guides.now(), filters[k].kept_floats(),
                    entry.half ? half.scratch().noisy : scratch.noisy, channels},
                   entry.half ? half.take_plane(unshadowed) : unshadowed);
    const bool passes = holds && rest.may_pass(k);
    if (passes) {
      rest.repeat(k, guides.now(), scratch.noisy, unshadowed, results);
      report.rested.push_back(entry.component);
      note_history(filters[k], report);
    }
    timer.end("rest", RestTurns::traffic(channels));
    if (passes) return true;
    timer.enter("");
    follow_surfaces(frame, entry.half, timer);
    timer.enter(component_name(entry.component));
    return false;
  }

  void run_component(const Frame& frame, std::size_t k, PlaneSet& results, FrameReport& report,
                     StageTimer& timer) {
    const Plan::Entry& entry = plan.components[k];
    ComponentFilter& component_filter = filters[k];
    const PlaneId id = signals[k];
    Plane& out = results.add(id, config.width, config.height);
    const ComponentInput input = input_of(frame, entry, report, timer);
    if (entry.half) {
      const ComponentInput halved = half.take(entry, input, scratch.noisy);
      timer.end("halve", 10);
      timer.size_images(0.25);
      component_filter.run(halved, half.scratch(), half.result(id));
      timer.size_images(1);
      half.upsample_result(id, scratch.noisy, out);
      if (input.unshadowed != nullptr)
        pass_unlit(*input.unshadowed, std::as_const(scratch.noisy)[0], out.channel(0));
      timer.end("upsample", 3 + 2 * out.channels());
    } else {
      component_filter.run(input, scratch, out);
    }
    note_history(component_filter, report);
    if (component_filter.changed_share() > 0)
      report.changes.push_back({entry.component, component_filter.changed_share()});
    if (config.debug_planes)
      write_debug_planes(entry.half ? half.scratch().debug : scratch.debug, entry.half,
                         entry.component, config.width, config.height, results);
    rest.filtered(k, component_filter, results);
  }

  void note_history(const ComponentFilter& filter, FrameReport& report) const {
    report.mean_history_frames +=
        filter.mean_history_frames() / static_cast<double>(filters.size());
  }

  /// Light of a visibility without shadows, where unlit places are left out; else null.
  const Plane* unshadowed_of(const Frame& frame, const Plan::Entry& entry) const {
    if (!entry.leaves_out_unlit) return nullptr;
    const auto id = PlaneId::of_light(PlaneKind::kUnshadowed, entry.component.light);
    const Plane* sent = frame.planes.find(id);
    return sent != nullptr ? sent : shaded.find(id);
  }

  /// What a frame says of a component, at the frame's own resolution.
  ComponentInput input_of(const Frame& frame, const Plan::Entry& entry, FrameReport& report,
                          StageTimer& timer) {
    ComponentInput input{.frames = {guides.now(), guides.previous(), scene}, .timer = timer};
    if (has_past) input.surface = &surface;
    input.key = {config.seed, frame.index};
    input.gradients = entry.gradients;
    if (entry.gradients) {
      const PlaneId gradient{PlaneKind::kGradient, entry.component};
      count_repairs(report, gradient,
                    load_gradients(frame.planes.at(gradient), kLargestRadiance, scratch.gradients));
    }
    input.unshadowed = unshadowed_of(frame, entry);
    if (entry.component.kind == ComponentKind::kVisibility && entry.has_footprint) {
      const std::uint32_t light = entry.component.light;
      input.light = &*std::find_if(config.lights.begin(), config.lights.end(),
                                   [&](const Light& l) { return l.id == light; });
      input.blockers = {&frame.planes.at(PlaneId::of_light(PlaneKind::kBlockerDistance, light)),
                        &frame.planes.at(PlaneId::of_light(PlaneKind::kLightSample, light)),
                        frame.planes.find(PlaneId::of_light(PlaneKind::kBlockerId, light))};
    }
    if (entry.cones) {
      cone_samples = {frame.planes.find({PlaneKind::kIndirectDirection, {}}), &scratch.noisy};
      input.cone_samples = {&cone_samples, 1};
    }
    if (entry.component.kind == ComponentKind::kGlossy &&
        (entry.has_footprint || entry.follows_effect))
      input.reflections = {&frame.planes.at({PlaneKind::kGlossyDirection, {}}),
                           &frame.planes.at({PlaneKind::kGlossyHitDistance, {}}),
                           frame.planes.find({PlaneKind::kGlossyHitId, {}})};
    return input;
  }

  /// Images that `compose` reads and writes: depth, its terms and the sum.
  int composite_channels(const PlaneSet& planes) const {
    int count = 1 + 3;
    for (const PlaneId id : signals) count += 3 + channel_count(id.kind);
    return count + (planes.find({PlaneKind::kEmission, {}}) ? 3 : 0);
  }

  static void count_repairs(FrameReport& report, PlaneId plane, std::uint64_t values) {
    if (values > 0) report.repaired.push_back({plane, values});
  }

  /// Calls `visit` for all images of `d`, an Impl, but those that keep histories.
  static void each_image(auto& d, auto&& visit) {
    GuidePair::each_image(d.guides, visit);
    Scratch::each_image(d.scratch, visit);
    SurfaceHistory::each_image(d.surface, visit);
    HalfFrame::each_image(d.half, visit);
    for (auto& plane : d.shaded) visit(plane);
  }
  ImageBytes image_bytes() const {
    ImageBytes sum;
    each_image(*this, sum);
    return sum;
  }

  DenoiserConfig config;
  Plan plan;
  std::shared_ptr<ScratchPool> pool;
  std::size_t need = 0;           ///< bytes that images are lent
  std::uint64_t images = 0;       ///< what the pool calls them
  std::optional<Plan> next_plan;  ///< of the preset from the next frame on, if that changes
  Scratch scratch;
  GuidePair guides;
  SurfaceHistory surface;
  HalfFrame half;
  std::unique_ptr<FrameFilter> oracle;  ///< in place of all that, with preset `reference`
  ConeSamples cone_samples{};           ///< of the component at hand
  SceneMotion scene;
  RestTurns rest;
  bool followed_full = false, followed_half = false;  ///< surfaces were, in this frame
  PlaneSet shaded;                                    ///< unshadowed light of `plan.shaded_lights`
  std::vector<ComponentFilter> filters;
  std::vector<PlaneId> signals;    ///< the planes of `filters`
  std::vector<PlaneId> announced;  ///< all result planes, in order
  std::int64_t last_index = std::numeric_limits<std::int64_t>::min();
  bool has_past = false;
};

}  // namespace holdfast
