#include "core/oracle/frame_oracle.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <optional>

#include "core/oracle/composite.h"

namespace holdfast::oracle {
namespace {

void write(const Image& image, Plane& out) {
  for_each_pixel(out.width(), out.height(), [&](int x, int y) {
    for (int c = 0; c < out.channels(); ++c)
      out.channel(c).at(x, y) = static_cast<float>(image.at(x, y, c));
  });
}

std::uint64_t count_non_finite(const Plane& plane) {
  std::uint64_t count = 0;
  for_each_pixel(plane.width(), plane.height(), [&](int x, int y) {
    for (int c = 0; c < plane.channels(); ++c)
      count += std::isfinite(plane.channel(c).at(x, y)) ? 0 : 1;
  });
  return count;
}

void add_repairs(FrameReport& report, PlaneId plane, std::uint64_t values) {
  if (values > 0) report.repaired.push_back({plane, values});
}

}  // namespace

FrameOracle::FrameOracle(const DenoiserConfig& config, const Plan& plan)
    : config_(config), plan_(plan) {
  for (const Plan::Entry& entry : plan.components) components_.emplace_back(config, plan, entry);
}

Surfaces FrameOracle::load(const Frame& frame, FrameReport& report) const {
  RepairedGeometry repaired;
  Surfaces out =
      load_surfaces(frame.planes, scene_.view(), plan_.roughness, plan_.motion, repaired);
  add_repairs(report, {PlaneKind::kDepth, {}}, repaired.depth);
  add_repairs(report, {PlaneKind::kNormal, {}}, repaired.normal);
  add_repairs(report, {PlaneKind::kRoughness, {}}, repaired.roughness);
  return out;
}

void FrameOracle::filter(const Frame& frame, bool has_past, PlaneSet& results, FrameReport& report,
                         StageTimer& timer) {
  scene_.advance(frame, config_.width, config_.height);
  Surfaces now = load(frame, report);
  timer.end("guides", 0);
  FrameView view{now, has_past ? previous_ : now, scene_};
  std::optional<Past> surface;
  if (has_past) {
    surface = surface_past(view, frame.planes.find({PlaneKind::kMotion, {}}));
    view.surface = &*surface;
    timer.end("surface", 0);
  }
  if (plan_.half.any) {
    half_.advance(now, scene_, frame.planes, has_past);
    timer.end("half", 0);
  }
  const std::vector<Image> filtered = filter_components(view, frame, results, report, timer);
  Plane& out = results.add({PlaneKind::kComposite, {}}, config_.width, config_.height);
  write(composite(now, filtered, frame, timer), out);
  report.non_finite_out = count_non_finite(out);
  timer.end("composite", 0);
  previous_ = std::move(now);
}

std::vector<Image> FrameOracle::filter_components(const FrameView& view, const Frame& frame,
                                                  PlaneSet& results, FrameReport& report,
                                                  StageTimer& timer) {
  std::vector<Image> filtered;
  for (ComponentOracle& oracle : components_) {
    const Component component = oracle.entry().component;
    ComponentOracle::Result result =
        oracle.entry().half ? oracle.run_halved(half_, view, frame) : oracle.run(view, frame);
    add_repairs(report, component_plane(component), result.repaired);
    add_repairs(report, {PlaneKind::kGradient, component}, result.repaired_gradients);
    if (result.changed_share > 0) report.changes.push_back({component, result.changed_share});
    report.mean_history_frames +=
        result.mean_history_frames / static_cast<double>(components_.size());
    const auto put = [&](PlaneId id, const Image& image) {
      write(image, results.add(id, config_.width, config_.height));
    };
    put(component_plane(component), result.filtered);
    if (config_.debug_planes) {
      put({PlaneKind::kDebugMotion, component}, result.motion);
      put({PlaneKind::kDebugHistory, component}, result.frames);
      put({PlaneKind::kDebugConfidence, component}, result.weight);
    }
    filtered.push_back(std::move(result.filtered));
    timer.enter(component_name(component));
    timer.end("all", 0);
  }
  timer.enter("");
  return filtered;
}

Image FrameOracle::composite(const Surfaces& now, const std::vector<Image>& filtered,
                             const Frame& frame, StageTimer& timer) const {
  const PlaneSet& planes = frame.planes;
  std::list<Image> shaded;  // so that adding one leaves pointers to others valid
  std::vector<Term> terms;
  for (std::size_t k = 0; k < filtered.size(); ++k) {
    const Component component = components_[k].entry().component;
    Term term{&filtered[k], nullptr, nullptr};
    if (component.kind != ComponentKind::kVisibility) {
      const bool glossy = component.kind == ComponentKind::kGlossy;
      term.given_factor = planes.find({glossy ? PlaneKind::kSpecular : PlaneKind::kAlbedo, {}});
      terms.push_back(term);
      continue;
    }
    term.given_factor = planes.find(PlaneId::of_light(PlaneKind::kUnshadowed, component.light));
    for (const Light& light : config_.lights) {
      const bool is_shaded = std::find(plan_.shaded_lights.begin(), plan_.shaded_lights.end(),
                                       light.id) != plan_.shaded_lights.end();
      if (light.id != component.light || !is_shaded) continue;
      shaded.push_back(shade(now, light, scene_.light(light.id), plan_.shaded_lobe, planes));
      term.own_factor = &shaded.back();
    }
    if (term.given_factor != nullptr || term.own_factor != nullptr) terms.push_back(term);
  }
  if (!shaded.empty()) timer.end("unshadowed", 0);
  return compose(now, terms, planes.find({PlaneKind::kEmission, {}}));
}

std::size_t FrameOracle::bytes() const {
  std::size_t sum = previous_.bytes() + half_.bytes();
  for (const ComponentOracle& component : components_) sum += component.bytes();
  return sum;
}

}  // namespace holdfast::oracle

namespace holdfast {

std::unique_ptr<FrameFilter> make_oracle(const DenoiserConfig& config, const Plan& plan) {
  return std::make_unique<oracle::FrameOracle>(config, plan);
}

}  // namespace holdfast
