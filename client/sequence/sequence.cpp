#include "client/sequence/sequence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "client/sequence/sequence_json.h"
#include "core/frame/error.h"
#include "core/frame/plane_size.h"

namespace holdfast {
namespace {

namespace fs = std::filesystem;
constexpr const char* kJsonName = "sequence.json";

/// Everything of a frame but its planes.
Frame without_planes(const Frame& frame) {
  Frame out;
  out.index = frame.index;
  out.cut = frame.cut;
  out.camera = frame.camera;
  out.objects = frame.objects;
  out.lights = frame.lights;
  return out;
}

std::string frame_subject(std::int64_t index) { return "frame " + std::to_string(index); }

bool is_finite(const glm::dmat4& matrix) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(matrix[c][r])) return false;
  return true;
}

void check_finite(std::int64_t index, const std::string& what, const glm::dmat4& matrix) {
  if (!is_finite(matrix))
    throw InputError(frame_subject(index) + ", " + what, "must be finite", "not finite");
}

/// The rules of a frame's own numbers, so that what is written can be read again.
void check_frame(const Frame& frame, const SequenceHeader& header) {
  check_finite(frame.index, "viewFromWorld", frame.camera.view_from_world);
  check_finite(frame.index, "clipFromView", frame.camera.clip_from_view);
  for (const auto& [id, matrix] : frame.objects) {
    if (id == 0) throw InputError(frame_subject(frame.index), "must use object ids > 0", "0");
    check_finite(frame.index, "object " + std::to_string(id), matrix);
  }
  for (const auto& [id, matrix] : frame.lights) {
    if (std::none_of(header.lights.begin(), header.lights.end(),
                     [id = id](const Light& light) { return light.id == id; }))
      throw InputError(frame_subject(frame.index), "must use lights of the header",
                       "light " + std::to_string(id));
    check_finite(frame.index, "light " + std::to_string(id), matrix);
  }
}

/// Each plane must have the size that its id has in a frame of `header`'s size.
void check_size(std::int64_t index, const PlaneSet& planes, const SequenceHeader& header) {
  for (const Plane& plane : planes) {
    const PlaneSize size = plane_size(plane.id(), header.width, header.height);
    const PlaneSize found{plane.width(), plane.height()};
    if (found != size)
      throw InputError(frame_subject(index) + ", plane " + plane_name(plane.id()),
                       "must be " + size_text(size), size_text(found));
  }
}

bool is_gradient(PlaneId id) { return id.kind == PlaneKind::kGradient; }

/// The light that a plane belongs to, if it belongs to one.
std::optional<std::uint32_t> light_of(PlaneId id) {
  const bool per_light = plane_traits(id.kind).per_light ||
                         (is_gradient(id) && id.component.kind == ComponentKind::kVisibility);
  return per_light ? std::optional(id.component.light) : std::nullopt;
}

void check_lights(const fs::path& file, const PlaneSet& planes, const SequenceHeader& header) {
  for (const Plane& plane : planes) {
    const std::optional<std::uint32_t> light = light_of(plane.id());
    if (light && std::none_of(header.lights.begin(), header.lights.end(),
                              [&](const Light& known) { return known.id == *light; }))
      throw InputError("file " + file.string() + ", plane " + plane_name(plane.id()),
                       "must belong to a light of sequence.json",
                       "of unknown light " + std::to_string(*light));
  }
}

bool is_sequence_image(const std::string& name) {
  return name.ends_with(".exr") && (name.starts_with("frame.") || name.starts_with("reference.") ||
                                    name.starts_with("gradient."));
}

void remove_old_sequence(const fs::path& dir) {
  if (!fs::exists(dir / kJsonName)) return;
  std::vector<fs::path> old{dir / kJsonName};
  for (const auto& entry : fs::directory_iterator(dir))
    if (is_sequence_image(entry.path().filename().string())) old.push_back(entry.path());
  for (const fs::path& file : old) fs::remove(file);
}

enum class FileKind { kFrame, kReference, kGradient };

/// Which planes may be in which file: inputs, results, gradients.
bool may_hold(FileKind file, PlaneKind plane) {
  const bool debug = plane == PlaneKind::kDebugMotion || plane == PlaneKind::kDebugHistory ||
                     plane == PlaneKind::kDebugConfidence;
  const bool result_only = plane == PlaneKind::kComposite || debug;
  const bool both = plane == PlaneKind::kVisibility || plane == PlaneKind::kGlossy ||
                    plane == PlaneKind::kIndirect;
  switch (file) {
    case FileKind::kFrame: return !result_only && plane != PlaneKind::kGradient;
    case FileKind::kReference: return result_only || both;
    case FileKind::kGradient: return plane == PlaneKind::kGradient;
  }
  return false;
}

PlaneSet read_planes(const fs::path& file, ImageSize size, FileKind kind, const char* rule) {
  PlaneSet planes = read_exr(file, size);
  for (const Plane& plane : planes)
    if (!may_hold(kind, plane.id().kind))
      throw InputError("file " + file.string(), rule, "holding " + plane_name(plane.id()));
  return planes;
}

}  // namespace

fs::path sequence_file(const fs::path& dir, const char* kind, std::int64_t index) {
  char name[64];
  std::snprintf(name, sizeof name, "%s.%04lld.exr", kind, static_cast<long long>(index));
  return dir / name;
}

SequenceWriter::SequenceWriter(fs::path dir, SequenceHeader header, ExrOptions options)
    : dir_(std::move(dir)), header_(std::move(header)), options_(options) {
  check_header(header_, "sequence " + dir_.string());
  fs::create_directories(dir_);
  remove_old_sequence(dir_);
}

void SequenceWriter::write_frame(const Frame& frame) {
  if (frame.index < 0)
    throw InputError(frame_subject(frame.index), "must have an index >= 0", "negative");
  if (!frames_.empty() && frame.index <= frames_.back().index)
    throw InputError(frame_subject(frame.index), "must come after the frame before",
                     "after " + std::to_string(frames_.back().index));
  check_frame(frame, header_);
  check_size(frame.index, frame.planes, header_);
  std::vector<const Plane*> planes, gradients;
  for (const Plane& plane : frame.planes)
    (is_gradient(plane.id()) ? gradients : planes).push_back(&plane);
  write_exr_planes(sequence_file(dir_, "frame", frame.index), planes, options_);
  if (!gradients.empty())
    write_exr_planes(sequence_file(dir_, "gradient", frame.index), gradients, options_);
  frames_.push_back(without_planes(frame));
}

void SequenceWriter::write_reference(std::int64_t index, const PlaneSet& planes) {
  check_size(index, planes, header_);
  write_exr(sequence_file(dir_, "reference", index), planes, options_);
}

void SequenceWriter::finish() { write_sequence_json(dir_ / kJsonName, header_, frames_); }

SequenceReader::SequenceReader(fs::path dir) : dir_(std::move(dir)) {
  if (!fs::is_directory(dir_))
    throw InputError("sequence " + dir_.string(), "must be an existing directory", "missing");
  SequenceDescription description = read_sequence_json(dir_ / kJsonName);
  header_ = std::move(description.header);
  frames_ = std::move(description.frames);
}

std::vector<std::int64_t> SequenceReader::frame_indices() const {
  std::vector<std::int64_t> indices;
  for (const Frame& frame : frames_) indices.push_back(frame.index);
  return indices;
}

Frame SequenceReader::read_frame(std::int64_t index, bool with_gradients) const {
  const auto it = std::find_if(frames_.begin(), frames_.end(),
                               [&](const Frame& frame) { return frame.index == index; });
  if (it == frames_.end())
    throw InputError("sequence " + dir_.string(), "must list the frame asked for",
                     "without frame " + std::to_string(index));
  Frame frame = without_planes(*it);
  const fs::path file = sequence_file(dir_, "frame", index);
  frame.planes = read_planes(file, size(), FileKind::kFrame, "must hold input planes only");
  for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal})
    if (!frame.planes.find({kind, {}}))
      throw InputError("file " + file.string() + ", channel " + channel_name({kind, {}}, 0),
                       "must be present", "missing");
  check_lights(file, frame.planes, header_);
  if (with_gradients && has_gradients()) {
    const fs::path gradient_file = sequence_file(dir_, "gradient", index);
    PlaneSet gradients = read_planes(gradient_file, gradient_size(), FileKind::kGradient,
                                     "must hold gradient planes only");
    check_lights(gradient_file, gradients, header_);
    for (Plane& plane : gradients)
      frame.planes.add(plane.id(), plane.width(), plane.height()) = std::move(plane);
  }
  return frame;
}

std::vector<PlaneId> SequenceReader::planes(bool with_gradients) const {
  const std::int64_t first = frames_.front().index;
  std::vector<PlaneId> planes = exr_planes(sequence_file(dir_, "frame", first), size());
  if (!with_gradients || !has_gradients()) return planes;
  for (const PlaneId id : exr_planes(sequence_file(dir_, "gradient", first), gradient_size()))
    planes.push_back(id);
  return planes;
}

bool SequenceReader::has_reference(std::int64_t index) const {
  return fs::exists(sequence_file(dir_, "reference", index));
}

PlaneSet SequenceReader::read_reference(std::int64_t index) const {
  return read_planes(sequence_file(dir_, "reference", index), size(), FileKind::kReference,
                     "must hold results only");
}

bool SequenceReader::has_gradients() const {
  return fs::exists(sequence_file(dir_, "gradient", frames_.front().index));
}

ImageSize SequenceReader::gradient_size() const {
  const PlaneSize strata = plane_size({PlaneKind::kGradient, {}}, header_.width, header_.height);
  return {strata.width, strata.height};
}

}  // namespace holdfast
