#pragma once

#include "core/denoiser/component_filter.h"
#include "core/denoiser/plan.h"
#include "core/history/guide_pair.h"
#include "core/spatial/half_grid.h"
#include "core/spatial/upsample.h"

namespace holdfast {

/// A frame at half its resolution: what the components that the plan filters there share, and the
/// way there and back. Empty where the plan has none.
class HalfFrame {
 public:
  HalfFrame() = default;
  HalfFrame(const DenoiserConfig& config, const Plan& plan);

  /// Takes a frame's guides and, of its `planes`, the motion vectors; the guides of the frame
  /// before stay. `has_past`: there is a frame before.
  void advance(const Guides& full, const SceneMotion& scene, const PlaneSet& planes, bool has_past);

  /// Finds the quads of a frame that shows what the last one did, for `take_signal`; all else
  /// stays.
  void find_quads(const Guides& full) { choose_representatives(full, grid_); }

  /// Takes the guides of a frame that was filtered without this one, as the frame before. Returns
  /// its quads.
  HalfGrid remember(const Guides& full);
  /// The last frame's guides, within a frame.
  const Guides& guides() const { return guides_.now(); }
  /// Between frames: a copy of the last one's guides.
  Guides last_guides() const { return guides_.last(); }
  std::size_t kept_guide_bytes() const { return guides_.kept_bytes(); }

  /// Takes the input of a component of the frame's size, whose samples are `noisy`. Returns what it
  /// is here; `scratch().noisy` holds the quads' means.
  ComponentInput take(const Plan::Entry& entry, const ComponentInput& full,
                      const Channels<float>& noisy);

  /// Takes the samples alone, `channels` of them, into `scratch().noisy`, by the quads of this
  /// frame.
  void take_signal(const Channels<float>& noisy, int channels) {
    halve_signal(noisy, channels, grid_, scratch_.noisy);
  }
  /// The representatives of a plane of the frame's size that a component here reads; null of null.
  const Plane* take_plane(const Plane* full);

  /// Where the component's filter writes.
  Plane& result(PlaneId id) { return *planes_.find(id); }
  /// Brings that result to the frame's size; pixels without surface show `noisy`.
  void upsample_result(PlaneId id, const Channels<float>& noisy, Plane& out) const;

  Scratch& scratch() { return scratch_; }
  /// Calls `visit` for all images of `h`, a HalfFrame.
  static void each_image(auto& h, auto&& visit) {
    HalfGrid::each_image(h.grid_, visit);
    Upsampling::each_image(h.upsampling_, visit);
    GuidePair::each_image(h.guides_, visit);
    SurfaceHistory::each_image(h.surface_, visit);
    Scratch::each_image(h.scratch_, visit);
    for (auto& plane : h.planes_) visit(plane);
    for (auto& images : h.samples_) visit(images);
    for (auto& plane : h.directions_) visit(plane);
  }

 private:
  static void take_guides(const Guides& full, HalfGrid& grid, Guides& half);
  void take_samples(const Channels<float>& noisy, const Plane& directions);
  void halve_vectors();

  int width_ = 0, height_ = 0;
  HalfGrid grid_;
  Upsampling upsampling_;
  GuidePair guides_;
  bool has_past_ = false;
  SceneMotion scene_;
  SurfaceHistory surface_;
  Scratch scratch_;
  PlaneSet planes_;                           ///< halved inputs, and results
  Channels<float> samples_[HalfGrid::kQuad];  ///< of each pixel of the quads, if kept by cones
  Plane directions_[HalfGrid::kQuad];
  ConeSamples cone_samples_[HalfGrid::kQuad] = {};
};

}  // namespace holdfast
