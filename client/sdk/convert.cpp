#include "client/sdk/convert.h"

#include <algorithm>

#include "core/frame/conventions.h"
#include "proto/plane_bytes.h"

namespace holdfast::client {
namespace {

v1::LightShape shape_of(LightShape shape) {
  switch (shape) {
    case LightShape::kRectangle: return v1::LIGHT_SHAPE_RECTANGLE;
    case LightShape::kDisk: return v1::LIGHT_SHAPE_DISK;
    case LightShape::kSphere: return v1::LIGHT_SHAPE_SPHERE;
    case LightShape::kPoint: return v1::LIGHT_SHAPE_POINT;
    case LightShape::kDirectional: return v1::LIGHT_SHAPE_DIRECTIONAL;
  }
  return v1::LIGHT_SHAPE_UNSPECIFIED;
}

void write_matrix(const glm::dmat4& matrix, v1::Matrix4& out) {
  double values[16];
  row_major_from_matrix(matrix, values);
  out.mutable_values()->Assign(values, values + 16);
}

/// `own` and what of `older` it does not name.
void write_transforms(const TransformTable& own, const TransformTable& older,
                      google::protobuf::RepeatedPtrField<v1::Transform>& out) {
  TransformTable all = own;
  all.insert(older.begin(), older.end());
  for (const auto& [id, matrix] : all) {
    v1::Transform& transform = *out.Add();
    transform.set_id(id);
    write_matrix(matrix, *transform.mutable_world_from_local());
  }
}

}  // namespace

void write_create_request(const SessionOptions& options, v1::CreateSessionRequest& request) {
  // A negative size wraps to a large one, which the server refuses by its rule.
  request.set_width_px(static_cast<std::uint32_t>(options.width));
  request.set_height_px(static_cast<std::uint32_t>(options.height));
  for (const Light& light : options.lights) {
    v1::Light& out = *request.add_lights();
    out.set_id(light.id);
    out.set_shape(shape_of(light.shape));
    out.set_width_m(light.width);
    out.set_height_m(light.height);
    out.set_radius(light.radius);
    if (light.radiance != glm::dvec3(0))
      for (int c = 0; c < 3; ++c) out.add_radiance(light.radiance[c]);
  }
  for (const PlaneId id : options.planes) request.add_planes(plane_name(id));
  request.set_recipe(options.recipe);
  request.set_preset(options.preset);
  request.set_indirect_basis(options.indirect_basis);
  for (const std::string& name : options.half_resolution) request.add_half_resolution(name);
  request.set_history(options.history);
  request.set_seed(options.seed);
  request.set_debug_planes(options.debug_planes);
  request.set_budget_ms(options.budget_ms);
  request.set_frames_per_second(options.frames_per_second);
  request.set_wire(options.wire);
  request.set_shared_memory(!options.shared_memory.empty());
  if (options.late_frames == LateFrames::kLatest) request.set_late_frames(v1::LATE_FRAMES_LATEST);
  for (const PlaneId id : options.results) request.add_result_planes(plane_name(id));
}

void write_frame_begin(const OutgoingFrame& out, const std::vector<PlaneId>& planes,
                       std::span<const wire::PlaneCoding> codings, v1::FrameBegin& begin) {
  const Frame& frame = *out.frame;
  begin.set_epoch(out.epoch);
  begin.set_index(frame.index);
  begin.set_cut(frame.cut);
  v1::Camera& camera = *begin.mutable_camera();
  write_matrix(frame.camera.view_from_world, *camera.mutable_view_from_world());
  write_matrix(frame.camera.clip_from_view, *camera.mutable_clip_from_view());
  camera.set_jitter_x_px(frame.camera.jitter_px.x);
  camera.set_jitter_y_px(frame.camera.jitter_px.y);
  write_transforms(frame.objects, out.objects, *begin.mutable_objects());
  write_transforms(frame.lights, out.lights, *begin.mutable_lights());
  begin.set_deadline_ms(out.deadline_ms);
  if (out.change) {
    v1::SessionChange& change = *begin.mutable_change();
    change.set_width_px(static_cast<std::uint32_t>(out.change->width));
    change.set_height_px(static_cast<std::uint32_t>(out.change->height));
    change.set_recipe(out.change->recipe);
    change.set_preset(out.change->preset);
  }
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Plane& plane = frame.planes.at(planes[i]);
    v1::FramePlane& announced = *begin.add_planes();
    announced.set_plane(static_cast<std::uint32_t>(i));
    announced.set_width_px(static_cast<std::uint32_t>(plane.width()));
    announced.set_height_px(static_cast<std::uint32_t>(plane.height()));
    announced.set_format(
        static_cast<v1::PlaneFormat>(wire::format_number(codings[i].format, plane.id().kind)));
    announced.set_codec(static_cast<v1::PlaneCodec>(codings[i].codec));
  }
}

void read_frame_result(const v1::FrameResult& result, FrameOutput& output) {
  output.index = result.index();
  if (result.has_error()) {
    output.error.emplace();
    output.error->message = result.error().message();
    output.error->refused = result.error().code() == v1::FRAME_ERROR_CODE_REFUSED;
    const v1::InputViolation& violation = result.error().violation();
    if (result.error().code() == v1::FRAME_ERROR_CODE_INVALID_FRAME)
      output.error->input.emplace(violation.subject(), violation.rule(), violation.value());
  }
  const v1::FrameTiming& timing = result.timing();
  output.timing.receive = timing.receive_ms();
  output.timing.wait = timing.wait_ms();
  output.timing.core = timing.core_ms();
  for (const v1::StageTime& stage : timing.stages())
    output.timing.stages.push_back({stage.stage(), stage.ms()});
  output.history_reset = result.history_reset();
  output.mean_history_frames = result.mean_history_frames();
  output.preset = result.preset();
  for (const v1::RepairCount& repair : result.repaired())
    output.repaired.push_back({repair.plane(), repair.values()});
  output.non_finite_out = result.non_finite_out();
  output.repeated = result.repeated();
  output.dropped = result.dropped();
  output.deadline_passed = result.deadline_passed();
}

void check_planes(const Frame& frame, const std::vector<PlaneId>& planes, int width, int height) {
  for (const PlaneId id : planes) {
    const Plane& plane = frame.planes.at(id);
    const PlaneSize size = plane_size(id, width, height);
    const PlaneSize found{plane.width(), plane.height()};
    if (found != size)
      throw InputError("plane " + plane_name(id), "must be " + size_text(size), size_text(found));
  }
  for (const Plane& plane : frame.planes)
    if (std::find(planes.begin(), planes.end(), plane.id()) == planes.end())
      throw InputError("plane " + plane_name(plane.id()), "must be a plane of the session",
                       "not declared");
}

}  // namespace holdfast::client
