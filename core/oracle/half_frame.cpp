#include "core/oracle/half_frame.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace holdfast::oracle {
namespace {

constexpr PlaneKind kRead[] = {
    PlaneKind::kMotion,      PlaneKind::kGlossyDirection, PlaneKind::kGlossyHitDistance,
    PlaneKind::kGlossyHitId, PlaneKind::kBlockerDistance, PlaneKind::kLightSample,
    PlaneKind::kBlockerId};

}  // namespace

void HalfFrame::advance(const Surfaces& full, const Scene& scene, const PlaneSet& planes,
                        bool has_past) {
  previous_ = std::move(now_);
  quads_ = choose_quads(full);
  now_ = halved(full, quads_);
  scene_ = scene.halved();
  has_past_ = has_past;
  for (const Plane& plane : planes)
    if (std::find(std::begin(kRead), std::end(kRead), plane.id().kind) != std::end(kRead))
      planes_.add(plane.id(), quads_.width, quads_.height) = halved(plane, quads_);
  Plane* motion = planes_.find({PlaneKind::kMotion, {}});
  if (motion != nullptr)
    for_each_pixel(quads_.width, quads_.height, [&](int x, int y) {
      for (int c = 0; c < 2; ++c) motion->channel(c).at(x, y) *= 0.5f;  // half as many pixels
    });
  surface_.reset();
  if (has_past_) surface_ = surface_past({now_, previous_, scene_}, motion);
}

}  // namespace holdfast::oracle
