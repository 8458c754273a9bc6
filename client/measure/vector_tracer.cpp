#include "client/measure/vector_tracer.h"

#include <algorithm>
#include <utility>

#include "core/denoiser/frame_input.h"
#include "core/frame/error.h"
#include "core/history/dual_history.h"
#include "core/history/glossy_history.h"
#include "core/history/shadow_history.h"
#include "core/spatial/window.h"

namespace holdfast::measure {
namespace {

constexpr int kStatisticsStep = 3;  // the denoiser's 9x9 window of local means
constexpr int kField = 2;           // it averages the field behind two channels of its own

Guides guides_of(const Frame& frame, const ViewGeometry& view) {
  Guides out(view.width, view.height);
  out.view = view;
  out.rays = view.rays.cast<float>();
  load_depth(frame.planes.at({PlaneKind::kDepth, {}}), out);
  load_normals(frame.planes.at({PlaneKind::kNormal, {}}), out);
  load_ids(frame.planes.find({PlaneKind::kObjectId, {}}), out.id);
  if (const Plane* roughness = frame.planes.find({PlaneKind::kRoughness, {}})) {
    out.roughness = Channels<float>(view.width, view.height, 1);
    load_roughness(*roughness, out);
  }
  return out;
}

Channels<Taps> copy_of(const Channels<Taps>& taps) {
  Channels<Taps> out(taps.width(), taps.height(), 1);
  for (int y = 0; y < taps.height(); ++y) std::copy_n(taps[0].row(y), taps.width(), out[0].row(y));
  return out;
}

}  // namespace

std::string_view vector_name(FollowedVector vector) {
  switch (vector) {
    case FollowedVector::kSurface: return "surface";
    case FollowedVector::kUnchecked: return "unchecked";
    case FollowedVector::kSpecular: return "specular";
    case FollowedVector::kStochastic: return "stochastic";
    case FollowedVector::kRelative: return "relative";
    case FollowedVector::kShadow: return "shadow";
    case FollowedVector::kBorrowed: return "borrowed";
    case FollowedVector::kDual: return "dual";
  }
  return "";
}

std::vector<FollowedVector> vectors_of(ComponentKind kind) {
  using enum FollowedVector;
  switch (kind) {
    case ComponentKind::kVisibility: return {kSurface, kShadow, kBorrowed};
    case ComponentKind::kGlossy: return {kSurface, kSpecular, kStochastic, kRelative};
    case ComponentKind::kIndirect: return {kUnchecked, kDual};
  }
  return {};
}

VectorTracer::VectorTracer(const Frame& before, const Frame& now, const std::vector<Light>& lights)
    : frame_(now), lights_(lights) {
  const Plane& depth = now.planes.at({PlaneKind::kDepth, {}});
  width_ = depth.width();
  height_ = depth.height();
  scene_.advance(before, width_, height_, lights);
  previous_ = guides_of(before, scene_.view());
  scene_.advance(now, width_, height_, lights);
  now_ = guides_of(now, scene_.view());
  surface_ = SurfaceHistory(width_, height_);
  trace_surface_history({now_, previous_, scene_}, nullptr, surface_);
}

Channels<Taps> VectorTracer::trace(FollowedVector vector, Component component,
                                   std::uint64_t seed) const {
  switch (vector) {
    case FollowedVector::kSurface: return copy_of(surface_.taps);
    case FollowedVector::kUnchecked: return trace_unchecked();
    case FollowedVector::kSpecular:
    case FollowedVector::kStochastic:
    case FollowedVector::kRelative: return trace_glossy(vector, seed);
    case FollowedVector::kShadow:
    case FollowedVector::kBorrowed: return trace_shadow(vector, component.light);
    case FollowedVector::kDual: break;
  }
  EffectHistory out(width_, height_);
  trace_dual_history({now_, previous_, scene_}, surface_, out);
  return std::move(out.taps);
}

Mask VectorTracer::hidden() const {
  Mask out;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      out.push_back(now_.depth().at(x, y) > 0.0f && !surface_.taps[0].at(x, y).any() ? 1 : 0);
  return out;
}

Channels<Taps> VectorTracer::trace_shadow(FollowedVector vector, std::uint32_t light_id) const {
  const auto light = std::find_if(lights_.begin(), lights_.end(),
                                  [&](const Light& l) { return l.id == light_id; });
  if (light == lights_.end())
    throw InputError("light", "must be one of the session's", std::to_string(light_id));
  const auto plane = [&](PlaneKind kind) { return PlaneId::of_light(kind, light_id); };
  const BlockerPlanes planes{&frame_.planes.at(plane(PlaneKind::kBlockerDistance)),
                             &frame_.planes.at(plane(PlaneKind::kLightSample)),
                             frame_.planes.find(plane(PlaneKind::kBlockerId))};
  const ShadowTracer tracer(now_, scene_, *light, planes);
  Channels<float> field(width_, height_, kField + kEffectFieldChannels);
  Channels<float> means(width_, height_, field.count());
  tracer.measure(field, kField);
  WindowScratch scratch(width_, height_);
  window_means(now_, field, field.count(), kStatisticsStep, scratch, means);
  EffectHistory out(width_, height_);
  trace_shadow_history(
      {now_, previous_, scene_}, tracer,
      vector == FollowedVector::kShadow ? ShadowRule::kPaper : ShadowRule::kBorrowed,
      std::as_const(means)[kField + kFieldValid], std::as_const(means)[kField + kFieldRatio],
      std::as_const(field)[kField + kFieldRatio], out);
  return std::move(out.taps);
}

Channels<Taps> VectorTracer::trace_glossy(FollowedVector vector, std::uint64_t seed) const {
  const GlossyPlanes planes{&frame_.planes.at({PlaneKind::kGlossyDirection, {}}),
                            &frame_.planes.at({PlaneKind::kGlossyHitDistance, {}}),
                            frame_.planes.find({PlaneKind::kGlossyHitId, {}})};
  const GlossyRule rule = vector == FollowedVector::kSpecular     ? GlossyRule::kSpecular
                          : vector == FollowedVector::kStochastic ? GlossyRule::kStochastic
                                                                  : GlossyRule::kRelative;
  EffectHistory out(width_, height_);
  trace_glossy_history({now_, previous_, scene_}, planes, rule, {seed, frame_.index}, out);
  return std::move(out.taps);
}

Channels<Taps> VectorTracer::trace_unchecked() const {
  Channels<Taps> out(width_, height_, 1);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      if (now_.depth().at(x, y) > 0.0f)
        out[0].at(x, y) = find_taps_on_any_surface(
            previous_, static_cast<float>(x) + 0.5f + surface_.motion[0].at(x, y),
            static_cast<float>(y) + 0.5f + surface_.motion[1].at(x, y));
  return out;
}

}  // namespace holdfast::measure
