#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "client/scenes/scene.h"
#include "client/scenes/view.h"
#include "client/scenes/world.h"
#include "core/frame/frame.h"

namespace holdfast::scenes {

struct RenderSettings {
  int width = 480, height = 270;  ///< pixels, 1..kMaxDimension
  int spp = 1;                    ///< samples per component and pixel of noisy frames, >= 1
  int reference_spp = 1024;       ///< the same of references, >= 1
  std::uint64_t seed = 1;
  double speed = 1.0;            ///< of all animation: frame i shows the scene at time i * speed
  std::int64_t first_frame = 0;  ///< its tables name every object and light
  bool gradients = true;         ///< frames bring gradient planes, too
};

/// Renders a scene frame by frame. The images are a function of scene, settings and frame index;
/// they do not depend on the number of threads or on what was rendered before.
class Renderer {
 public:
  /// Throws InputError for settings out of range, a scene without camera keys or with an id twice
  /// or 0, and meshes that cannot be read.
  Renderer(Scene scene, const RenderSettings& settings);
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  const Scene& scene() const { return scene_; }
  std::vector<Light> lights() const;
  std::vector<std::pair<std::uint32_t, std::string>> objects() const;

  /// Noisy frame `index` with camera, transforms (all in the first frame, later those of what moved
  /// since frame index - 1 and of objects that appeared; lights are there from the first frame on,
  /// switched on or not), the planes of `render_noisy`, and gradient planes against
  /// frame index - 1. These are (0, 0), no samples, in the first frame, at cuts, and where nothing
  /// has moved.
  Frame frame(std::int64_t index);
  /// Planes of `render_reference`; valid until the next call. Kept as long as nothing moves.
  const PlaneSet& reference(std::int64_t index);

 private:
  double time_of(std::int64_t index) const { return static_cast<double>(index) * settings_.speed; }
  bool at_rest_between(double a, double b) const;
  View view_at(double time, std::int64_t index);

  Scene scene_;
  RenderSettings settings_;
  World world_;
  PlaneSet reference_;
  bool has_reference_ = false;
  double reference_time_ = 0.0;
};

}  // namespace holdfast::scenes
