#include "core/denoiser/half_frame.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// Whether a component reads input plane `id` besides its samples.
bool reads(const Plan::Entry& entry, PlaneId id) {
  const bool glossy = entry.component.kind == ComponentKind::kGlossy;
  switch (id.kind) {
    case PlaneKind::kGlossyDirection:
    case PlaneKind::kGlossyHitDistance:
    case PlaneKind::kGlossyHitId: return glossy && (entry.has_footprint || entry.follows_effect);
    case PlaneKind::kBlockerDistance:
    case PlaneKind::kLightSample:
    case PlaneKind::kBlockerId: return entry.has_footprint && id.component == entry.component;
    case PlaneKind::kUnshadowed: return entry.leaves_out_unlit && id.component == entry.component;
    default: return false;
  }
}

}  // namespace

HalfFrame::HalfFrame(const DenoiserConfig& config, const Plan& plan)
    : width_(half_size(config.width)),
      height_(half_size(config.height)),
      grid_(config.width, config.height, Memory::kLent),
      upsampling_(config.width, config.height, Memory::kLent),
      guides_(width_, height_, plan.roughness, plan.motion, plan.history_format),
      scratch_(width_, height_, plan, plan.half, config.debug_planes) {
  constexpr auto kLent = Memory::kLent;
  if (plan.history) surface_ = SurfaceHistory(width_, height_, kLent);
  for (const Plan::Entry& entry : plan.components)
    if (entry.half) planes_.add(component_plane(entry.component), width_, height_, kLent);
  std::vector<PlaneId> inputs = config.planes;
  for (const std::uint32_t light : plan.shaded_lights)
    inputs.push_back(PlaneId::of_light(PlaneKind::kUnshadowed, light));
  for (const PlaneId id : inputs) {
    const bool read =
        std::any_of(plan.components.begin(), plan.components.end(),
                    [&](const Plan::Entry& entry) { return entry.half && reads(entry, id); });
    if (read || id.kind == PlaneKind::kMotion) planes_.add(id, width_, height_, kLent);
  }
  if (std::none_of(plan.components.begin(), plan.components.end(),
                   [](const Plan::Entry& entry) { return entry.half && entry.cones; }))
    return;
  for (int k = 0; k < HalfGrid::kQuad; ++k) {
    samples_[k] = Channels<float>(width_, height_, 3, kLent);
    directions_[k] = Plane({PlaneKind::kIndirectDirection, {}}, width_, height_, kLent);
  }
}

void HalfFrame::advance(const Guides& full, const SceneMotion& scene, const PlaneSet& planes,
                        bool has_past) {
  has_past_ = has_past;
  scene_.follow_halved(scene);
  take_guides(full, grid_, guides_.advance(has_past));
  guides_.keep();
  upsampling_.find(full, guides_.now());
  scratch_.window.weights.clear();
  if (!has_past) return;
  const Plane* motion = take_plane(planes.find({PlaneKind::kMotion, {}}));
  if (motion != nullptr) halve_vectors();
  trace_surface_history({guides_.now(), guides_.previous(), scene_}, motion, surface_);
}

HalfGrid HalfFrame::remember(const Guides& full) {
  HalfGrid grid(full.view.width, full.view.height);
  Guides half = guides_.blank();
  take_guides(full, grid, half);
  guides_.set_last(std::move(half));
  return grid;
}

void HalfFrame::take_guides(const Guides& full, HalfGrid& grid, Guides& half) {
  half.view = full.view.halved();
  half.rays = half.view.rays.cast<float>();
  choose_representatives(full, grid);
  halve_guides(full, grid, half);
}

const Plane* HalfFrame::take_plane(const Plane* full) {
  if (full == nullptr) return nullptr;
  Plane* half = planes_.find(full->id());
  halve_plane(*full, grid_, *half);
  return half;
}

/// The client's motion vectors in half pixels.
void HalfFrame::halve_vectors() {
  Plane& motion = *planes_.find({PlaneKind::kMotion, {}});
  for_each_row(height_, [&](int y) {
    for (int c = 0; c < 2; ++c)
      for (int x = 0; x < width_; ++x) motion.channel(c).at(x, y) *= 0.5f;
  });
}

/// The samples of the quads' surfaces, each with its own direction.
void HalfFrame::take_samples(const Channels<float>& noisy, const Plane& directions) {
  for (int k = 0; k < HalfGrid::kQuad; ++k) cone_samples_[k] = {&directions_[k], &samples_[k]};
  const int last_x = noisy.width() - 1, last_y = noisy.height() - 1;
  for_each_row(height_, [&](int y) {
    for (int k = 0; k < HalfGrid::kQuad; ++k)
      for (int x = 0; x < width_; ++x) {
        const int px = std::min(2 * x + k % 2, last_x), py = std::min(2 * y + k / 2, last_y);
        const bool shown = grid_.share[k].at(x, y) > 0.0f;
        for (int c = 0; c < 3; ++c) {
          samples_[k][c].at(x, y) = noisy[c].at(px, py);
          directions_[k].channel(c).at(x, y) = shown ? directions.channel(c).at(px, py) : 0.0f;
        }
      }
  });
}

ComponentInput HalfFrame::take(const Plan::Entry& entry, const ComponentInput& full,
                               const Channels<float>& noisy) {
  ComponentInput half{.frames = {guides_.now(), guides_.previous(), scene_},
                      .surface = has_past_ ? &surface_ : nullptr,
                      .light = full.light,
                      .timer = full.timer,
                      .key = full.key};
  if (entry.cones) {
    take_samples(noisy, *full.cone_samples[0].directions);
    half.cone_samples = cone_samples_;
    half.quads = &grid_;
  } else {
    take_signal(noisy, channel_count(component_plane(entry.component).kind));
  }
  const auto& [direction, distance, hit] = full.reflections;
  half.reflections = {take_plane(direction), take_plane(distance), take_plane(hit)};
  const auto& [blocker_distance, sample, blocker] = full.blockers;
  half.blockers = {take_plane(blocker_distance), take_plane(sample), take_plane(blocker)};
  half.unshadowed = take_plane(full.unshadowed);
  return half;
}

void HalfFrame::upsample_result(PlaneId id, const Channels<float>& noisy, Plane& out) const {
  const Plane& half = planes_.at(id);
  Upsampling::Signal signal;
  signal.channels = half.channels();
  for (int c = 0; c < half.channels(); ++c) {
    signal.in[c] = half.channel(c);
    signal.beyond[c] = noisy[c];
    signal.out[c] = out.channel(c);
  }
  upsampling_.run(signal);
}

}  // namespace holdfast
