#include "client/sequence/sequence_json.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "client/sequence/strict_json.h"
#include "core/frame/conventions.h"
#include "core/frame/error.h"

namespace holdfast {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
constexpr std::string_view kFormat = "holdfast-sequence";
constexpr std::int64_t kVersion = 1;
constexpr std::int64_t kMaxId = std::numeric_limits<std::uint32_t>::max();

/// The elements of an optional array, each as an object with its path.
std::vector<StrictObject> objects_of(StrictObject& parent, const std::string& key) {
  std::vector<StrictObject> out;
  const Json* array = parent.optional(key);
  if (!array) return out;
  if (!array->is_array())
    throw InputError(parent.subject(key), "must be an array", json_excerpt(*array));
  for (std::size_t i = 0; i < array->size(); ++i)
    out.emplace_back((*array)[i], parent.file(), parent.path(key) + "[" + std::to_string(i) + "]");
  return out;
}

double light_size(StrictObject& json, const std::string& key) {
  const double value = json.number(key);
  if (value < 0) throw InputError(json.subject(key), "must be >= 0", std::to_string(value));
  return value;
}

glm::dvec3 read_radiance(StrictObject& json) {
  const Json* value = json.optional("radiance");
  if (!value) return glm::dvec3(0);
  glm::dvec3 radiance(-1);
  if (value->is_array() && value->size() == 3)
    for (std::size_t c = 0; c < 3; ++c)
      if ((*value)[c].is_number()) radiance[static_cast<int>(c)] = (*value)[c].get<double>();
  for (int c = 0; c < 3; ++c)
    if (!(radiance[c] >= 0) || !std::isfinite(radiance[c]))
      throw InputError(json.subject("radiance"), "must be 3 numbers >= 0", json_excerpt(*value));
  return radiance;
}

Light read_light(StrictObject& json) {
  Light light;
  light.id = static_cast<std::uint32_t>(json.integer("id", 0, kMaxId));
  const std::string shape = json.text("shape");
  const auto known = light_shape_from_name(shape);
  if (!known)
    throw InputError(json.subject("shape"), "must be rectangle, disk, sphere, point or directional",
                     '"' + shortened(shape) + '"');
  light.shape = *known;
  if (light.shape == LightShape::kRectangle) {
    light.width = light_size(json, "width");
    light.height = light_size(json, "height");
  } else if (light.shape != LightShape::kPoint) {
    light.radius = light_size(json, "radius");
  }
  light.radiance = read_radiance(json);
  json.finish();
  return light;
}

SequenceHeader read_header(StrictObject& json) {
  if (const std::string format = json.text("format"); format != kFormat)
    throw InputError(json.subject("format"), "must be \"" + std::string(kFormat) + '"',
                     '"' + shortened(format) + '"');
  if (const Json& version = json.required("version"); version != kVersion)
    throw InputError(json.subject("version"), "must be 1", json_excerpt(version));
  SequenceHeader header;
  header.width = static_cast<int>(json.integer("width", 1, kMaxDimension));
  header.height = static_cast<int>(json.integer("height", 1, kMaxDimension));
  if (json.optional("frameRate")) header.frame_rate = json.number("frameRate");
  for (StrictObject& light : objects_of(json, "lights")) header.lights.push_back(read_light(light));
  for (StrictObject& object : objects_of(json, "objects")) {
    const auto id = static_cast<std::uint32_t>(object.integer("id", 1, kMaxId));
    header.objects.emplace_back(id, object.optional("name") ? object.text("name") : "");
    object.finish();
  }
  check_header(header, "file " + json.file());
  return header;
}

Camera read_camera(StrictObject json) {
  Camera camera;
  camera.view_from_world = json.matrix("viewFromWorld");
  camera.clip_from_view = json.matrix("clipFromView");
  if (const Json* jitter = json.optional("jitterPx")) {
    const bool pair = jitter->is_array() && jitter->size() == 2 && (*jitter)[0].is_number() &&
                      (*jitter)[1].is_number();
    if (!pair)
      throw InputError(json.subject("jitterPx"), "must be 2 numbers", json_excerpt(*jitter));
    camera.jitter_px = {(*jitter)[0].get<double>(), (*jitter)[1].get<double>()};
  }
  json.finish();
  return camera;
}

std::uint32_t id_from_key(const StrictObject& json, const std::string& key, std::uint32_t lowest) {
  std::uint32_t id = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), id);
  if (error != std::errc{} || end != key.data() + key.size() || std::to_string(id) != key ||
      id < lowest)
    throw InputError(json.subject(key),
                     "must have an id in " + std::to_string(lowest) + "..4294967295 as its key",
                     '"' + shortened(key) + '"');
  return id;
}

TransformTable read_transforms(StrictObject& frame, const std::string& key, std::uint32_t lowest) {
  TransformTable table;
  const Json* value = frame.optional(key);
  if (!value) return table;
  StrictObject json(*value, frame.file(), frame.path(key));
  for (const auto& item : value->items())
    table[id_from_key(json, item.key(), lowest)] = json.matrix(item.key());
  return table;
}

Frame read_frame_entry(StrictObject& json, const std::set<std::uint32_t>& lights) {
  Frame frame;
  frame.index = json.integer("index", 0, std::numeric_limits<std::int64_t>::max());
  if (const Json* cut = json.optional("cut")) {
    if (!cut->is_boolean())
      throw InputError(json.subject("cut"), "must be true or false", json_excerpt(*cut));
    frame.cut = cut->get<bool>();
  }
  frame.camera = read_camera({json.required("camera"), json.file(), json.path("camera")});
  frame.objects = read_transforms(json, "objects", 1);
  frame.lights = read_transforms(json, "lights", 0);
  for (const auto& [id, transform] : frame.lights)
    if (!lights.contains(id))
      throw InputError(json.subject("lights"), "must use ids of the sequence's lights",
                       std::to_string(id));
  json.finish();
  return frame;
}

OrderedJson matrix_json(const glm::dmat4& matrix) {
  std::vector<double> numbers(16);
  row_major_from_matrix(matrix, numbers.data());
  return numbers;
}

OrderedJson light_json(const Light& light) {
  OrderedJson json{{"id", light.id}, {"shape", light_shape_name(light.shape)}};
  if (light.shape == LightShape::kRectangle) {
    json["width"] = light.width;
    json["height"] = light.height;
  } else if (light.shape != LightShape::kPoint) {
    json["radius"] = light.radius;
  }
  if (light.radiance != glm::dvec3(0))
    json["radiance"] = {light.radiance.r, light.radiance.g, light.radiance.b};
  return json;
}

OrderedJson frame_json(const Frame& frame) {
  OrderedJson json{{"index", frame.index},
                   {"cut", frame.cut},
                   {"camera",
                    {{"viewFromWorld", matrix_json(frame.camera.view_from_world)},
                     {"clipFromView", matrix_json(frame.camera.clip_from_view)},
                     {"jitterPx", {frame.camera.jitter_px.x, frame.camera.jitter_px.y}}}},
                   {"objects", OrderedJson::object()},
                   {"lights", OrderedJson::object()}};
  for (const auto& [id, matrix] : frame.objects)
    json["objects"][std::to_string(id)] = matrix_json(matrix);
  for (const auto& [id, matrix] : frame.lights)
    json["lights"][std::to_string(id)] = matrix_json(matrix);
  return json;
}

}  // namespace

void check_header(const SequenceHeader& header, const std::string& subject) {
  const auto in_range = [](int size) { return size >= 1 && size <= kMaxDimension; };
  if (!in_range(header.width) || !in_range(header.height))
    throw InputError(subject, "must have width and height in 1.." + std::to_string(kMaxDimension),
                     std::to_string(header.width) + "x" + std::to_string(header.height));
  if (!(header.frame_rate > 0) || !std::isfinite(header.frame_rate))
    throw InputError(subject + ", frameRate", "must be > 0", std::to_string(header.frame_rate));
  std::set<std::uint32_t> lights, objects;
  for (const Light& light : header.lights)
    if (!lights.insert(light.id).second)
      throw InputError(subject + ", lights", "must list each id once",
                       "listing " + std::to_string(light.id) + " twice");
  for (const auto& [id, name] : header.objects)
    if (!objects.insert(id).second)
      throw InputError(subject + ", objects", "must list each id once",
                       "listing " + std::to_string(id) + " twice");
}

SequenceDescription read_sequence_json(const std::filesystem::path& file) {
  const Json json = read_json_file(file.string());
  StrictObject top(json, file.string(), "");
  SequenceDescription out;
  out.header = read_header(top);
  std::set<std::uint32_t> lights;
  for (const Light& light : out.header.lights) lights.insert(light.id);
  top.required("frames");
  for (StrictObject& entry : objects_of(top, "frames")) {
    Frame frame = read_frame_entry(entry, lights);
    if (!out.frames.empty() && frame.index <= out.frames.back().index)
      throw InputError(
          entry.subject("index"),
          "must be greater than the frame before, " + std::to_string(out.frames.back().index),
          std::to_string(frame.index));
    out.frames.push_back(std::move(frame));
  }
  if (out.frames.empty())
    throw InputError(top.subject("frames"), "must list at least one frame", "empty");
  top.finish();
  return out;
}

void write_sequence_json(const std::filesystem::path& file, const SequenceHeader& header,
                         const std::vector<Frame>& frames) {
  OrderedJson json{{"format", kFormat},
                   {"version", kVersion},
                   {"width", header.width},
                   {"height", header.height},
                   {"frameRate", header.frame_rate}};
  json["lights"] = OrderedJson::array();
  for (const Light& light : header.lights) json["lights"].push_back(light_json(light));
  json["objects"] = OrderedJson::array();
  for (const auto& [id, name] : header.objects)
    json["objects"].push_back(OrderedJson{{"id", id}, {"name", name}});
  json["frames"] = OrderedJson::array();
  for (const Frame& frame : frames) json["frames"].push_back(frame_json(frame));
  std::ofstream stream(file);
  stream << json.dump(1) << '\n';
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace holdfast
