#include "server/calibration.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "core/kernels/random.h"

namespace holdfast::server {
namespace {

constexpr int kWidth = 160, kHeight = 90;  // pixels
constexpr int kFrames = 3;  // of each preset; the first has no history and is left out
constexpr std::uint32_t kLight = 0;

DenoiserConfig full_session() {
  DenoiserConfig config;
  config.width = kWidth;
  config.height = kHeight;
  config.lights = {{kLight, LightShape::kRectangle, 1, 1, 0}};
  for (const PlaneKind kind :
       {PlaneKind::kVisibility, PlaneKind::kBlockerDistance, PlaneKind::kLightSample})
    config.planes.push_back(PlaneId::of_light(kind, kLight));
  for (const PlaneKind kind :
       {PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kRoughness, PlaneKind::kAlbedo,
        PlaneKind::kGlossy, PlaneKind::kGlossyDirection, PlaneKind::kGlossyHitDistance,
        PlaneKind::kIndirect, PlaneKind::kIndirectDirection})
    config.planes.push_back({kind, {}});
  return config;
}

/// A value of a wall that faces the camera: noise, but for its geometry.
float value_of(PlaneKind kind, int channel, float noise) {
  switch (kind) {
    case PlaneKind::kDepth: return 5;
    case PlaneKind::kNormal: return channel == 2 ? 1 : 0;
    case PlaneKind::kVisibility: return noise < 0.5f ? 0 : 1;
    case PlaneKind::kGlossyDirection:
    case PlaneKind::kIndirectDirection: return channel == 2 ? 0.8f : 0.8f * noise - 0.4f;
    default: return noise;
  }
}

/// Camera and light move, so that everything is followed.
Frame frame_of(const DenoiserConfig& config, int index) {
  Frame frame;
  frame.index = index;
  const double aspect = static_cast<double>(config.width) / config.height;
  frame.camera.view_from_world = glm::translate(glm::dmat4(1), {-0.02 * index, 0, 0});
  frame.camera.clip_from_view = glm::perspective(0.9, aspect, 0.1, 100.0);
  frame.lights[kLight] = glm::translate(glm::dmat4(1), {0.1 * index, 0.5, -1});
  std::uint64_t key = static_cast<std::uint64_t>(index) << 32;
  for (const PlaneId id : config.planes) {
    Plane& plane = frame.planes.add(id, config.width, config.height);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < config.height; ++y)
        for (int x = 0; x < config.width; ++x)
          plane.channel(c).at(x, y) = value_of(id.kind, c, uniform_pair(++key).u);
  }
  return frame;
}

/// The cheaper of two measurements of each part: what else the machine did only adds.
PresetCost least(const PresetCost& a, const PresetCost& b) {
  return {std::min(a.frame, b.frame), std::min(a.visibility, b.visibility),
          std::min(a.glossy, b.glossy), std::min(a.indirect, b.indirect)};
}

}  // namespace

CostTable calibrate() {
  DenoiserConfig config = full_session();
  std::vector<Frame> frames;
  for (int index = 0; index < kFrames; ++index) frames.push_back(frame_of(config, index));
  CostTable table;
  for (const std::string& preset : kernel_preset_names()) {
    config.preset = preset;
    Denoiser denoiser(config);
    PlaneSet results;
    std::vector<PresetCost> costs;
    for (const Frame& frame : frames)
      costs.push_back(
          cost_of_stages(denoiser.filter(frame, results).stages, 1.0 * kWidth * kHeight));
    PresetCost cost = costs[1];
    for (std::size_t i = 2; i < costs.size(); ++i) cost = least(cost, costs[i]);
    table.push_back(cost);
  }
  return table;
}

}  // namespace holdfast::server
