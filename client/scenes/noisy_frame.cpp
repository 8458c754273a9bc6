#include "client/scenes/noisy_frame.h"

#include <algorithm>
#include <limits>

#include "client/scenes/glossy.h"
#include "client/scenes/light_target.h"
#include "client/scenes/noise.h"
#include "client/scenes/path.h"
#include "client/scenes/pixel_writer.h"
#include "client/scenes/sampling.h"
#include "client/scenes/shadow_ray.h"
#include "core/kernels/parallel.h"

namespace holdfast::scenes {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// Views of all planes of one light.
struct LightPlanes {
  LightPlanes(PlaneSet& planes, std::uint32_t id, int width, int height)
      : unshadowed(planes, PlaneId::of_light(PlaneKind::kUnshadowed, id), width, height),
        visibility(planes, PlaneId::of_light(PlaneKind::kVisibility, id), width, height),
        distance(planes, PlaneId::of_light(PlaneKind::kBlockerDistance, id), width, height),
        blocker(planes, PlaneId::of_light(PlaneKind::kBlockerId, id), width, height),
        sample(planes, PlaneId::of_light(PlaneKind::kLightSample, id), width, height) {}

  PixelWriter unshadowed, visibility, distance;
  IdWriter blocker;
  PixelWriter sample;
};

class NoisyFrame {
 public:
  NoisyFrame(const View& view, int spp, GradientSamples* gradients, PlaneSet& planes)
      : view_(view),
        spp_(spp),
        gradients_(gradients),
        depth_(planes, {PlaneKind::kDepth, {}}, view.width, view.height),
        normal_(planes, {PlaneKind::kNormal, {}}, view.width, view.height),
        object_id_(planes, {PlaneKind::kObjectId, {}}, view.width, view.height) {
    const auto plane = [&](PlaneKind kind) {
      return PixelWriter(planes, {kind, {}}, view.width, view.height);
    };
    if (glows(view.scene)) emission_ = plane(PlaneKind::kEmission);
    if (view.scene.components.glossy) {
      roughness_ = plane(PlaneKind::kRoughness);
      specular_ = plane(PlaneKind::kSpecular);
      glossy_ = plane(PlaneKind::kGlossy);
      glossy_direction_ = plane(PlaneKind::kGlossyDirection);
      hit_distance_ = plane(PlaneKind::kGlossyHitDistance);
      hit_id_ = IdWriter(planes, {PlaneKind::kGlossyHitId, {}}, view.width, view.height);
    }
    if (view.scene.components.indirect) {
      albedo_ = plane(PlaneKind::kAlbedo);
      indirect_ = plane(PlaneKind::kIndirect);
      indirect_direction_ = plane(PlaneKind::kIndirectDirection);
    }
    if (view.scene.components.visibility)
      for (const LightState& light : view.lights)
        lights_.emplace_back(planes, light.light.id, view.width, view.height);
  }

  void render_pixel(int x, int y) const {
    const auto primary = primary_at(view_, x, y);
    if (!primary) return render_sky(x, y);
    if (gradients_ && gradients_->is_chosen(x, y)) gradients_->record_surface(x, y, *primary);
    const Surface& surface = primary->surface;
    depth_.set(x, y, primary->depth_view_m);
    normal_.set(x, y, surface.normal);
    object_id_.set(x, y, primary->object_id);
    emission_.set(x, y, surface.emission);
    for (std::size_t k = 0; k < lights_.size(); ++k) render_light(x, y, k, surface);
    if (glossy_) render_glossy(x, y, surface);
    if (indirect_) render_indirect(x, y, surface);
  }

 private:
  void record(int x, int y, std::uint64_t stream, double luminance) const {
    if (gradients_ && gradients_->is_chosen(x, y)) gradients_->record_now(x, y, stream, luminance);
  }

  void render_sky(int x, int y) const {
    depth_.set(x, y, static_cast<double>(kInf));
    emission_.set(x, y, view_.scene.sky.radiance(pixel_direction(view_, x, y)));
    for (const LightPlanes& light : lights_) {
      light.visibility.set(x, y, 1.0);
      light.distance.set(x, y, static_cast<double>(kInf));
    }
    hit_distance_.set(x, y, static_cast<double>(kInf));
  }

  void render_light(int x, int y, std::size_t k, const Surface& surface) const {
    const LightPlanes& out = lights_[k];
    const LightTarget target(view_.lights[k], surface);
    out.unshadowed.set(x, y, target.unshadowed());
    out.visibility.set(x, y, 1.0);
    out.distance.set(x, y, static_cast<double>(kInf));
    record(x, y, kFirstLight + k, 1.0);
    if (!target.reaches()) return;
    Rng rng = noise_of(view_, x, y, kFirstLight + k);
    int visible = 0;
    for (int i = 0; i < spp_; ++i) {
      const glm::dvec2 uv = target.draw(rng);
      const ShadowRay ray =
          shadow_ray(surface, sample_light(view_.lights[k], surface.position, uv));
      const auto hit = view_.world.nearest(surface.origin, ray.direction, ray.length_m);
      if (i == 0 || (hit && visible == i)) {
        out.sample.set(x, y, uv);
        if (hit) out.distance.set(x, y, glm::distance(hit->position, surface.position));
        if (hit) out.blocker.set(x, y, view_.scene.objects[hit->object].id);
      }
      if (!hit) ++visible;
      if (i == 0) record(x, y, kFirstLight + k, visible);
    }
    out.visibility.set(x, y, static_cast<double>(visible) / spp_);
  }

  void render_glossy(int x, int y, const Surface& surface) const {
    roughness_.set(x, y, surface.roughness);
    specular_.set(x, y, specular_factor(surface));
    hit_distance_.set(x, y, static_cast<double>(kInf));
    Rng rng = noise_of(view_, x, y, kGlossyStream);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < spp_; ++i) {
      const LobeSample lobe = sample_lobe(surface, rng.next2());
      if (lobe.direction == glm::dvec3(0.0)) continue;
      const Incident incident =
          trace_path(view_.scene, view_.world, view_.lights, surface.origin, lobe.direction, rng);
      sum += lobe.weight * incident.radiance;
      if (i > 0) continue;
      record(x, y, kGlossyStream, luminance(lobe.weight * incident.radiance));
      glossy_direction_.set(x, y, lobe.direction);
      if (!incident.hit) continue;
      hit_distance_.set(x, y, glm::distance(incident.hit->position, surface.position));
      hit_id_.set(x, y, view_.scene.objects[incident.hit->object].id);
    }
    glossy_.set(x, y, sum / static_cast<double>(spp_));
  }

  void render_indirect(int x, int y, const Surface& surface) const {
    albedo_.set(x, y, surface.albedo);
    Rng rng = noise_of(view_, x, y, kIndirectStream);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < spp_; ++i) {
      const glm::dvec3 direction = sample_cosine(surface.normal, rng.next2());
      sum += trace_path(view_.scene, view_.world, view_.lights, surface.origin, direction, rng)
                 .radiance;
      if (i > 0) continue;
      record(x, y, kIndirectStream, luminance(sum));
      indirect_direction_.set(x, y, direction);
    }
    indirect_.set(x, y, sum / static_cast<double>(spp_));
  }

  const View& view_;
  int spp_;
  GradientSamples* gradients_;
  PixelWriter depth_, normal_;
  IdWriter object_id_;
  PixelWriter emission_, roughness_, specular_, glossy_, glossy_direction_, hit_distance_;
  IdWriter hit_id_;
  PixelWriter albedo_, indirect_, indirect_direction_;
  std::vector<LightPlanes> lights_;
};

}  // namespace

PlaneSet render_noisy(const View& view, int spp, GradientSamples* gradients) {
  PlaneSet planes;
  const NoisyFrame frame(view, spp, gradients, planes);
  for_each_index(0, view.height, 1, [&](int y) {
    for (int x = 0; x < view.width; ++x) frame.render_pixel(x, y);
  });
  return planes;
}

}  // namespace holdfast::scenes
