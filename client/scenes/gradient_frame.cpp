#include "client/scenes/gradient_frame.h"

#include <algorithm>

#include "client/scenes/glossy.h"
#include "client/scenes/light_target.h"
#include "client/scenes/path.h"
#include "client/scenes/pixel_writer.h"
#include "client/scenes/sampling.h"
#include "client/scenes/shadow_ray.h"
#include "core/kernels/parallel.h"

namespace holdfast::scenes {
namespace {

constexpr std::uint64_t kStratumStream = 1ull << 40;  // far from those of components

/// How an object's surface gets from one frame to the frame before.
struct Carry {
  bool was_there = true;
  bool at_rest = true;
  glm::dmat4 point{1.0};
  glm::dmat3 normal{1.0};
};

Carry carry_of(const Object& object, double now_frame, double then_frame) {
  Carry carry;
  carry.was_there = then_frame >= object.from_frame;
  const glm::dmat4 now = object.motion.at(now_frame).matrix();
  const glm::dmat4 then = object.motion.at(then_frame).matrix();
  carry.at_rest = now == then;
  if (carry.at_rest) return carry;
  carry.point = then * glm::inverse(now);
  carry.normal = glm::transpose(glm::inverse(glm::dmat3(carry.point)));
  return carry;
}

/// The surface one frame ago, as the camera of that frame saw it.
Surface carried(const Surface& now, const Carry& carry, const glm::dvec3& eye, bool camera_rests) {
  Surface then = now;
  if (!carry.at_rest) {
    then.position = glm::dvec3(carry.point * glm::dvec4(now.position, 1.0));
    then.normal = glm::normalize(carry.normal * now.normal);
    then.geometric_normal = glm::normalize(carry.normal * now.geometric_normal);
    then.origin = offset_origin(then.position, then.geometric_normal);
  }
  // At rest it stays as it is to the last bit.
  if (!carry.at_rest || !camera_rests) then.to_viewer = glm::normalize(eye - then.position);
  return then;
}

double shade_light(const View& view, std::size_t k, const Surface& surface, Rng rng) {
  const LightTarget target(view.lights[k], surface);
  if (!target.reaches()) return 1.0;
  const ShadowRay ray =
      shadow_ray(surface, sample_light(view.lights[k], surface.position, target.draw(rng)));
  return view.world.occluded(surface.origin, ray.direction, ray.length_m) ? 0.0 : 1.0;
}

double shade_glossy(const View& view, const Surface& surface, Rng rng) {
  const LobeSample lobe = sample_lobe(surface, rng.next2());
  if (lobe.direction == glm::dvec3(0.0)) return 0.0;
  return luminance(lobe.weight * trace_path(view.scene, view.world, view.lights, surface.origin,
                                            lobe.direction, rng)
                                     .radiance);
}

double shade_indirect(const View& view, const Surface& surface, Rng rng) {
  const glm::dvec3 direction = sample_cosine(surface.normal, rng.next2());
  return luminance(
      trace_path(view.scene, view.world, view.lights, surface.origin, direction, rng).radiance);
}

double shade(const View& view, std::uint64_t stream, const Surface& surface, Rng rng) {
  if (stream == kGlossyStream) return shade_glossy(view, surface, rng);
  if (stream == kIndirectStream) return shade_indirect(view, surface, rng);
  return shade_light(view, stream - kFirstLight, surface, rng);
}

/// A stream and the gradient plane that it ends in.
struct GradientPlane {
  std::uint64_t stream;
  PixelWriter writer;
};

std::vector<GradientPlane> add_planes(const View& view, PlaneSet& out) {
  std::vector<GradientPlane> planes;
  const auto add = [&](std::uint64_t stream, Component component) {
    const PlaneId id{PlaneKind::kGradient, component};
    const PlaneSize size = plane_size(id, view.width, view.height);
    planes.push_back({stream, PixelWriter(out, id, size.width, size.height)});
  };
  const SceneComponents& wanted = view.scene.components;
  if (wanted.visibility)
    for (std::size_t k = 0; k < view.lights.size(); ++k)
      add(kFirstLight + k, {ComponentKind::kVisibility, view.lights[k].light.id});
  if (wanted.glossy) add(kGlossyStream, {ComponentKind::kGlossy, 0});
  if (wanted.indirect) add(kIndirectStream, {ComponentKind::kIndirect, 0});
  return planes;
}

}  // namespace

GradientSamples::GradientSamples(const View& now)
    : size_(plane_size({PlaneKind::kGradient, {}}, now.width, now.height)) {
  samples_.resize(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height));
  for (int y = 0; y < size_.height; ++y)
    for (int x = 0; x < size_.width; ++x) {
      const int left = kStratum * x, top = kStratum * y;
      const glm::dvec2 u = noise_of(now, left, top, kStratumStream).next2();
      Sample& sample = at(left, top);
      sample.x = left + static_cast<int>(u.x * std::min(kStratum, now.width - left));
      sample.y = top + static_cast<int>(u.y * std::min(kStratum, now.height - top));
      sample.now.assign(kFirstLight + now.lights.size(), 0.0);
    }
}

void GradientSamples::record_surface(int x, int y, const Primary& primary) {
  Sample& sample = at(x, y);
  sample.is_surface = true;
  sample.object = primary.object;
  sample.surface = primary.surface;
}

void GradientSamples::finish(const View& then, double now_frame, double then_frame,
                             PlaneSet& out) const {
  std::vector<Carry> carries;
  for (const Object& object : then.scene.objects)
    carries.push_back(carry_of(object, now_frame, then_frame));
  const Motion& camera = then.scene.camera.motion;
  const bool camera_rests = camera.at(now_frame) == camera.at(then_frame);
  const glm::dvec3 eye = camera.at(then_frame).translation;
  const std::vector<GradientPlane> planes = add_planes(then, out);
  for_each_index(0, size_.height, 1, [&](int y) {
    for (int x = 0; x < size_.width; ++x) {
      const Sample& sample = at(kStratum * x, kStratum * y);
      if (!sample.is_surface || !carries[sample.object].was_there) continue;
      const Surface surface = carried(sample.surface, carries[sample.object], eye, camera_rests);
      for (const GradientPlane& plane : planes) {
        const Rng rng = noise_of(then, sample.x, sample.y, plane.stream);
        plane.writer.set(
            x, y, glm::dvec2(sample.now[plane.stream], shade(then, plane.stream, surface, rng)));
      }
    }
  });
}

void add_empty_gradients(const View& view, PlaneSet& out) { add_planes(view, out); }

}  // namespace holdfast::scenes
