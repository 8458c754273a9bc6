#include "server/convert.h"

#include <algorithm>
#include <cmath>

#include "core/frame/conventions.h"
#include "core/frame/error.h"
#include "proto/wire_profile.h"
#include "server/config.h"

namespace holdfast::server {
namespace {

// Names of planes in a session; so many lights have 1551 planes with all that belongs to a frame.
constexpr int kMaxPlanes = 2048;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string quoted(const std::string& text) { return "\"" + text.substr(0, 64) + "\""; }

/// `name` if it is one of `names`, `fallback` if it is empty.
std::string checked_name(const char* subject, const std::string& name,
                         const std::vector<std::string>& names, const std::string& fallback) {
  if (name.empty()) return fallback;
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError(subject, "must be one of " + joined(names), quoted(name));
  return name;
}

int checked_dimension(const char* subject, std::uint32_t value) {
  if (value < 1 || value > static_cast<std::uint32_t>(kMaxDimension))
    throw InputError(subject, "must be in 1.." + std::to_string(kMaxDimension),
                     std::to_string(value));
  return static_cast<int>(value);
}

LightShape shape_from(const v1::Light& light) {
  switch (light.shape()) {
    case v1::LIGHT_SHAPE_RECTANGLE: return LightShape::kRectangle;
    case v1::LIGHT_SHAPE_DISK: return LightShape::kDisk;
    case v1::LIGHT_SHAPE_SPHERE: return LightShape::kSphere;
    case v1::LIGHT_SHAPE_POINT: return LightShape::kPoint;
    case v1::LIGHT_SHAPE_DIRECTIONAL: return LightShape::kDirectional;
    default:
      throw InputError("shape of light " + std::to_string(light.id()),
                       "must be set to a known shape",
                       std::to_string(static_cast<int>(light.shape())));
  }
}

glm::dvec3 radiance_from(const v1::Light& light) {
  if (light.radiance().empty()) return glm::dvec3(0);
  if (light.radiance_size() != 3)
    throw InputError("radiance of light " + std::to_string(light.id()), "must have 3 numbers",
                     std::to_string(light.radiance_size()));
  return {light.radiance(0), light.radiance(1), light.radiance(2)};
}

/// A message has room for half a million names, and each is compared with those before it.
void check_count(const char* subject, int count) {
  if (count > kMaxPlanes)
    throw InputError(subject, "must be at most " + std::to_string(kMaxPlanes),
                     std::to_string(count));
}

std::vector<PlaneId> planes_from(const google::protobuf::RepeatedPtrField<std::string>& names) {
  check_count("number of planes", names.size());
  std::vector<PlaneId> planes;
  for (const std::string& name : names) {
    const std::optional<PlaneId> id = plane_from_name(name);
    if (!id) throw InputError("plane " + quoted(name), "must be a plane of the format", "unknown");
    if (std::find(planes.begin(), planes.end(), *id) != planes.end())
      throw InputError("plane " + name, "must be declared once", "declared twice");
    planes.push_back(*id);
  }
  return planes;
}

/// The planes to send: all, or those asked for, in the core's order.
std::vector<PlaneId> results_from(const v1::CreateSessionRequest& request,
                                  const DenoiserConfig& config) {
  check_count("number of result planes", request.result_planes_size());
  std::vector<PlaneId> all = result_planes(config);
  if (request.result_planes().empty()) return all;
  std::vector<std::string> names;
  for (const PlaneId id : all) names.push_back(plane_name(id));
  for (const std::string& name : request.result_planes())
    checked_name("result plane", name.empty() ? "\"\"" : name, names, {});
  std::erase_if(all, [&](PlaneId id) {
    const auto& wanted = request.result_planes();
    return std::find(wanted.begin(), wanted.end(), plane_name(id)) == wanted.end();
  });
  return all;
}

glm::dmat4 matrix_from(const std::string& subject, bool present, const v1::Matrix4& matrix) {
  if (!present) throw InputError(subject, "must be present", "missing");
  if (matrix.values_size() != 16)
    throw InputError(subject, "must have 16 numbers", std::to_string(matrix.values_size()));
  return matrix_from_row_major(matrix.values().data());
}

void read_transforms(const char* what,
                     const google::protobuf::RepeatedPtrField<v1::Transform>& transforms,
                     TransformTable& table) {
  table.clear();
  for (const v1::Transform& t : transforms) {
    const std::string subject = what + std::to_string(t.id());
    const glm::dmat4 matrix =
        matrix_from("transform of " + subject, t.has_world_from_local(), t.world_from_local());
    if (!table.emplace(t.id(), matrix).second)
      throw InputError(subject, "must be listed once in a frame", "listed twice");
  }
}

void check_rate(const SessionConfig& config) {
  const double rate = config.frames_per_second;
  if (!(rate >= 0) || !std::isfinite(rate))
    throw InputError("frames per second", "must be finite and at least 0", std::to_string(rate));
  if (rate > 0 && config.denoiser.preset == "reference")
    throw InputError("frames per second",
                     "must be 0 with preset reference, whose costs are not known",
                     std::to_string(rate));
}

void check_budget(const SessionConfig& config) {
  if (config.budget_ms > 0 && config.denoiser.preset == "reference")
    throw InputError("budget", "must be 0 with preset reference, which no other can stand in for",
                     std::to_string(config.budget_ms));
}

double ms_between(FrameSlot::TimePoint a, FrameSlot::TimePoint b) {
  return std::chrono::duration<double, std::milli>(b - a).count();
}

}  // namespace

SessionConfig session_config_from(const v1::CreateSessionRequest& request) {
  SessionConfig config;
  DenoiserConfig& core = config.denoiser;
  core.width = checked_dimension("width", request.width_px());
  core.height = checked_dimension("height", request.height_px());
  if (request.lights_size() > kMaxLights)
    throw InputError("number of lights", "must be at most " + std::to_string(kMaxLights),
                     std::to_string(request.lights_size()));
  for (const v1::Light& light : request.lights())
    core.lights.push_back({light.id(), shape_from(light), light.width_m(), light.height_m(),
                           light.radius(), radiance_from(light)});
  core.planes = planes_from(request.planes());
  const auto& ablations = ablation_names();  // not announced, for measurements
  const bool ablated =
      std::find(ablations.begin(), ablations.end(), request.recipe()) != ablations.end();
  core.recipe =
      checked_name("recipe", request.recipe(), ablated ? ablations : recipe_names(), core.recipe);
  core.preset = checked_name("preset", request.preset(), preset_names(), core.preset);
  core.indirect_basis = request.indirect_basis();
  core.half_resolution.assign(request.half_resolution().begin(), request.half_resolution().end());
  core.history = request.history();
  core.seed = request.seed();
  core.debug_planes = request.debug_planes();
  config.wire = checked_name("wire", request.wire(), wire::profile_names(), config.wire);
  config.budget_ms = request.budget_ms();
  if (!(config.budget_ms >= 0) || !std::isfinite(config.budget_ms))
    throw InputError("budget", "must be finite and at least 0 ms",
                     std::to_string(config.budget_ms));
  check_budget(config);
  config.frames_per_second = request.frames_per_second();
  check_rate(config);
  config.latest = request.late_frames() == v1::LATE_FRAMES_LATEST;
  config.results = results_from(request, core);
  return config;
}

SessionConfig changed_config(const v1::SessionChange& change, SessionConfig config) {
  DenoiserConfig& core = config.denoiser;
  if (change.width_px() != 0) core.width = checked_dimension("width", change.width_px());
  if (change.height_px() != 0) core.height = checked_dimension("height", change.height_px());
  core.recipe = checked_name("recipe", change.recipe(), recipe_names(), core.recipe);
  core.preset = checked_name("preset", change.preset(), preset_names(), core.preset);
  check_budget(config);
  check_rate(config);
  return config;
}

void read_frame_header(const v1::FrameBegin& begin, const SessionConfig& config, Frame& frame) {
  frame.index = begin.index();
  frame.cut = begin.cut();
  const std::string subject = "camera of frame " + std::to_string(begin.index());
  if (!(begin.deadline_ms() >= 0) || !std::isfinite(begin.deadline_ms()))
    throw InputError("deadline of frame " + std::to_string(begin.index()),
                     "must be finite and at least 0 ms", std::to_string(begin.deadline_ms()));
  if (!begin.has_camera()) throw InputError(subject, "must be present", "missing");
  const v1::Camera& camera = begin.camera();
  frame.camera.view_from_world = matrix_from(
      "view_from_world of " + subject, camera.has_view_from_world(), camera.view_from_world());
  frame.camera.clip_from_view = matrix_from("clip_from_view of " + subject,
                                            camera.has_clip_from_view(), camera.clip_from_view());
  frame.camera.jitter_px = {camera.jitter_x_px(), camera.jitter_y_px()};
  read_transforms("object ", begin.objects(), frame.objects);
  read_transforms("light ", begin.lights(), frame.lights);
  for (const auto& entry : frame.lights) {
    const auto& lights = config.denoiser.lights;
    if (std::none_of(lights.begin(), lights.end(),
                     [&](const Light& light) { return light.id == entry.first; }))
      throw InputError("light " + std::to_string(entry.first), "must be a light of the session",
                       "unknown");
  }
}

void write_frame_result(const FrameSlot& slot, const SessionConfig& config,
                        std::span<const wire::PlaneCoding> codings, v1::FrameResult& result) {
  result.set_index(slot.frame.index);
  v1::FrameTiming& timing = *result.mutable_timing();
  timing.set_receive_ms(ms_between(slot.begun, slot.ended));
  timing.set_wait_ms(ms_between(slot.ended, slot.started));
  if (slot.error) {
    *result.mutable_error() = *slot.error;
    return;
  }
  const FrameReport& report = slot.answer->report;
  result.set_repeated(slot.repeated);
  result.set_dropped(slot.answer->dropped);
  result.set_deadline_passed(slot.late);
  if (slot.answer->dropped) return;
  result.set_preset(report.preset);
  timing.set_core_ms(report.ms);
  for (const StageTime& stage : report.stages) {
    v1::StageTime& out = *timing.add_stages();
    out.set_stage(stage.stage);
    out.set_ms(stage.ms);
  }
  for (std::size_t i = 0; i < config.results.size(); ++i) {
    const Plane& plane = slot.answer->results.at(config.results[i]);
    v1::FramePlane& out = *result.add_planes();
    out.set_plane(static_cast<std::uint32_t>(i));
    out.set_width_px(static_cast<std::uint32_t>(plane.width()));
    out.set_height_px(static_cast<std::uint32_t>(plane.height()));
    out.set_format(
        static_cast<v1::PlaneFormat>(wire::format_number(codings[i].format, plane.id().kind)));
    out.set_codec(static_cast<v1::PlaneCodec>(codings[i].codec));
  }
  result.set_history_reset(report.history_reset);
  result.set_mean_history_frames(report.mean_history_frames);
  for (const RepairCount& repair : report.repaired) {
    v1::RepairCount& out = *result.add_repaired();
    out.set_plane(plane_name(repair.plane));
    out.set_values(repair.values);
  }
  result.set_non_finite_out(report.non_finite_out);
}

}  // namespace holdfast::server
