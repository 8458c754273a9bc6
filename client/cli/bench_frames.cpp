#include "client/cli/bench_frames.h"

#include <algorithm>
#include <filesystem>

#include "client/scenes/load.h"
#include "client/scenes/renderer.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

constexpr int kHeld = 4;       // frames in memory: 170 MB each at 1920x1080 with three components
constexpr int kMostHeld = 31;  // of small ones in a long stream, whose noise must not repeat soon
constexpr double kHeldPixels = 4.0 * 1920 * 1080;

int held(int width, int height, int length) {
  const int fitting = static_cast<int>(kHeldPixels / (static_cast<double>(width) * height));
  return std::clamp(std::min(length / 2, fitting), kHeld, kMostHeld);
}

bool same_place(const Frame& a, const Frame& b) {
  return a.camera.view_from_world == b.camera.view_from_world &&
         a.camera.clip_from_view == b.camera.clip_from_view && a.objects == b.objects &&
         a.lights == b.lights;
}

/// Adds to each frame's table what stands where an earlier frame put it: frames are also played
/// backwards.
void complete_tables(std::vector<Frame>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    frames[i].objects.insert(frames[i - 1].objects.begin(), frames[i - 1].objects.end());
    frames[i].lights.insert(frames[i - 1].lights.begin(), frames[i - 1].lights.end());
  }
}

/// "visibility", "glossy" or "indirect" for a plane of such a component, else nothing.
std::string component_kind(PlaneId id) {
  switch (id.kind) {
    case PlaneKind::kUnshadowed:
    case PlaneKind::kVisibility:
    case PlaneKind::kBlockerDistance:
    case PlaneKind::kBlockerId:
    case PlaneKind::kLightSample: return "visibility";
    case PlaneKind::kGlossy:
    case PlaneKind::kGlossyDirection:
    case PlaneKind::kGlossyHitDistance:
    case PlaneKind::kGlossyHitId: return "glossy";
    case PlaneKind::kIndirect:
    case PlaneKind::kIndirectDirection: return "indirect";
    case PlaneKind::kGradient: return component_kind(component_plane(id.component));
    default: return "";
  }
}

}  // namespace

BenchFrames::BenchFrames(const std::string& scene, int width, int height, int length) {
  if (std::filesystem::is_directory(scene))
    read(scene, length);
  else
    render(scene, width, height, length);
  complete_tables(frames_);
  moves_ = !std::all_of(frames_.begin(), frames_.end(),
                        [&](const Frame& frame) { return same_place(frame, frames_.front()); });
  if (!moves_ && frames_.size() % 2 == 0) frames_.pop_back();
  for (const Plane& plane : frames_.front().planes) config_.planes.push_back(plane.id());
}

void BenchFrames::read(const std::string& dir, int length) {
  const SequenceReader sequence(dir);
  config_.width = sequence.header().width;
  config_.height = sequence.header().height;
  config_.lights = sequence.header().lights;
  for (const std::int64_t index : sequence.frame_indices()) {
    if (static_cast<int>(frames_.size()) == held(config_.width, config_.height, length)) break;
    frames_.push_back(sequence.read_frame(index));
  }
}

void BenchFrames::render(const std::string& scene, int width, int height, int length) {
  scenes::RenderSettings settings;
  settings.width = width;
  settings.height = height;
  scenes::Renderer renderer(scenes::load_scene(scene), settings);
  config_.width = width;
  config_.height = height;
  config_.lights = renderer.lights();
  for (int i = 0; i < held(width, height, length); ++i) frames_.push_back(renderer.frame(i));
}

template <class Wanted>
void BenchFrames::drop_unless(const Wanted& wanted) {
  const auto unwanted = [&](PlaneId id) { return !wanted(id); };
  for (const PlaneId id : config_.planes)
    if (unwanted(id))
      for (Frame& frame : frames_) frame.planes.remove(id);
  std::erase_if(config_.planes, unwanted);
}

bool BenchFrames::has(PlaneKind kind) const {
  return std::any_of(config_.planes.begin(), config_.planes.end(),
                     [&](PlaneId id) { return id.kind == kind; });
}

void BenchFrames::keep(const std::vector<std::string>& kinds) {
  for (const std::string& kind : kinds) {
    if (kind != "visibility" && kind != "glossy" && kind != "indirect")
      throw InputError("option --signals", "must name visibility, glossy or indirect",
                       "'" + kind + "'");
    if (std::none_of(config_.planes.begin(), config_.planes.end(),
                     [&](PlaneId id) { return component_kind(id) == kind; }))
      throw InputError("option --signals", "must name what the scene has", "'" + kind + "'");
  }
  drop_unless([&](PlaneId id) {
    const std::string kind = component_kind(id);
    return kind.empty() || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  });
}

void BenchFrames::keep_one_signal() {
  if (!has(PlaneKind::kIndirect) && !has(PlaneKind::kGlossy))
    throw InputError("option --one-signal", "needs a scene with indirect light or reflections",
                     "neither");
  const auto signal = has(PlaneKind::kIndirect) ? PlaneKind::kIndirect : PlaneKind::kGlossy;
  drop_unless([&](PlaneId id) {
    return id.kind == PlaneKind::kDepth || id.kind == PlaneKind::kNormal ||
           id.kind == PlaneKind::kObjectId || id.kind == signal;
  });
}

const Frame& BenchFrames::at(int step) {
  const int last = static_cast<int>(frames_.size()) - 1;
  const int phase = last > 0 ? step % (moves_ ? 2 * last : last + 1) : 0;
  Frame& frame =
      frames_[static_cast<std::size_t>(std::min(phase, moves_ ? 2 * last - phase : last))];
  frame.index = step;
  frame.cut = false;
  return frame;
}

}  // namespace holdfast::cli
