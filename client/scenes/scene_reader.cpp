#include <cmath>

#include <nlohmann/json.hpp>

#include "client/scenes/json_values.h"
#include "client/scenes/scene_json.h"
#include "client/sequence/strict_json.h"
#include "core/frame/error.h"

namespace holdfast::scenes {
namespace {

using Json = nlohmann::json;

Transform read_transform(StrictObject& in) {
  Transform out;
  out.translation = vector_or<3>(in, "translation", out.translation);
  if (const Json* value = in.optional("rotation")) {
    const glm::dvec4 q = vector_of<4>(in, "rotation", *value);
    if (std::abs(glm::length(q) - 1.0) > 1e-3)
      throw InputError(in.subject("rotation"), "must be a unit quaternion", json_excerpt(*value));
    out.rotation = glm::dquat(q.w, q.x, q.y, q.z);
  }
  if (const Json* value = in.optional("lookAt")) {
    if (in.json().contains("rotation"))
      throw InputError(in.subject("lookAt"), "must not stand beside rotation",
                       json_excerpt(*value));
    const glm::dvec3 target = vector_of<3>(in, "lookAt", *value);
    if (target == out.translation)
      throw InputError(in.subject("lookAt"), "must differ from translation", json_excerpt(*value));
    if (const glm::dvec3 way = target - out.translation;
        !std::isfinite(way.x) || !std::isfinite(way.y) || !std::isfinite(way.z))
      throw InputError(in.subject("lookAt"), "must be a finite way from translation",
                       json_excerpt(*value));
    out.rotation = look_at(out.translation, target).rotation;
  }
  out.scale = vector_or<3>(in, "scale", out.scale);
  if (out.scale.x * out.scale.y * out.scale.z == 0.0)
    throw InputError(in.subject("scale"), "must not be 0", json_excerpt(*in.optional("scale")));
  return out;
}

Repeat read_repeat(StrictObject& in) {
  const Json* value = in.optional("repeat");
  if (!value || *value == "hold") return Repeat::kHold;
  if (*value == "loop") return Repeat::kLoop;
  if (*value == "mirror") return Repeat::kMirror;
  throw InputError(in.subject("repeat"), "must be hold, loop or mirror", json_excerpt(*value));
}

Motion read_motion(StrictObject& parent) {
  if (!parent.optional("motion")) return Motion();
  StrictObject in = child(parent, "motion");
  const Json* keys = in.optional("keys");
  if (!keys) {
    const Motion still(read_transform(in));
    in.finish();
    return still;
  }
  Motion motion;
  motion.keys.clear();
  motion.repeat = read_repeat(in);
  each(in, "keys", *keys, [&](StrictObject& item) {
    Key key;
    key.frame = item.number("frame");
    key.transform = read_transform(item);
    if (const Json* jump = item.optional("jump")) {
      if (!jump->is_boolean())
        throw InputError(item.subject("jump"), "must be true or false", json_excerpt(*jump));
      key.jump = jump->get<bool>();
    }
    if (!motion.keys.empty() && !(key.frame > motion.keys.back().frame))
      throw InputError(item.subject("frame"), "must be later than the key before",
                       std::to_string(key.frame));
    motion.keys.push_back(key);
  });
  if (motion.keys.empty()) throw InputError(in.subject("keys"), "must hold a key", "[]");
  in.finish();
  return motion;
}

/// A motion that cannot scale: of lights, whose size is a number of its own, and of cameras.
Motion read_rigid_motion(StrictObject& parent) {
  Motion motion = read_motion(parent);
  for (const Key& key : motion.keys)
    if (key.transform.scale != glm::dvec3(1.0))
      throw InputError(parent.subject("motion"), "must not scale", "scaled");
  return motion;
}

Part read_part(StrictObject& in, const std::filesystem::path& folder) {
  Part part;
  const std::string shape = in.text("shape");
  if (shape == "box") {
    part.shape = PartShape::kBox;
    part.size_m = vector_or<3>(in, "size", part.size_m);
  } else if (shape == "quad") {
    part.shape = PartShape::kQuad;
    const glm::dvec2 size = vector_or<2>(in, "size", glm::dvec2(1.0));
    part.size_m = {size.x, 0.0, size.y};
  } else if (shape == "sphere") {
    part.shape = PartShape::kSphere;
    part.radius_m = positive_or(in, "radius", part.radius_m);
  } else if (shape == "cylinder") {
    part.shape = PartShape::kCylinder;
    part.radius_m = positive_or(in, "radius", part.radius_m);
    part.height_m = positive_or(in, "height", part.height_m);
  } else if (shape == "mesh") {
    part.shape = PartShape::kMesh;
    part.file = folder / in.text("file");
  } else {
    throw InputError(in.subject("shape"), "must be box, quad, sphere, cylinder or mesh",
                     shortened(shape));
  }
  const double thickness = part.shape == PartShape::kQuad ? 1.0 : part.size_m.y;
  if (!(part.size_m.x > 0.0 && thickness > 0.0 && part.size_m.z > 0.0))
    throw InputError(in.subject("size"), "must be greater than 0",
                     json_excerpt(in.required("size")));
  part.placement = read_transform(in);
  return part;
}

Material read_material(StrictObject& parent) {
  Material material;
  if (!parent.optional("material")) return material;
  StrictObject in = child(parent, "material");
  material.albedo = colour_or(in, "albedo", material.albedo, 1.0);
  if (in.optional("checker")) {
    StrictObject checker = child(in, "checker");
    material.checker = Checker{};
    material.checker->albedo = colour_or(checker, "albedo", material.checker->albedo, 1.0);
    material.checker->size_m = positive_or(checker, "size", material.checker->size_m);
    checker.finish();
  }
  material.roughness = number_or(in, "roughness", material.roughness, 0.0, 1.0);
  material.specular = colour_or(in, "specular", material.specular, 1.0);
  material.emission = colour_or(in, "emission", material.emission, kNoLimit);
  in.finish();
  return material;
}

Object read_object(StrictObject& in, const std::filesystem::path& folder) {
  Object object;
  object.id = static_cast<std::uint32_t>(in.integer("id", 1, 0xffffffffll));
  if (in.optional("name")) object.name = in.text("name");
  object.from_frame = number_or(in, "fromFrame", 0.0);
  object.material = read_material(in);
  each(in, "parts", in.required("parts"),
       [&](StrictObject& part) { object.parts.push_back(read_part(part, folder)); });
  if (object.parts.empty()) throw InputError(in.subject("parts"), "must hold a part", "[]");
  object.motion = read_motion(in);
  return object;
}

SceneLight read_light(StrictObject& in) {
  SceneLight out;
  out.light.id = static_cast<std::uint32_t>(in.integer("id", 0, 0xffffffffll));
  const std::string name = in.text("shape");
  const auto shape = light_shape_from_name(name);
  if (!shape)
    throw InputError(in.subject("shape"), "must be rectangle, disk, sphere, point or directional",
                     shortened(name));
  out.light.shape = *shape;
  out.light.width = number_or(in, "width", 0.0, 0.0);
  out.light.height = number_or(in, "height", 0.0, 0.0);
  out.light.radius = number_or(in, "radius", 0.0, 0.0);
  const bool flat =
      *shape == LightShape::kRectangle && !(out.light.width > 0 && out.light.height > 0);
  const bool round = *shape == LightShape::kDisk || *shape == LightShape::kSphere;
  if (flat) throw InputError(in.subject("width"), "and height must be greater than 0", "0");
  if (round && !(out.light.radius > 0))
    throw InputError(in.subject("radius"), "must be greater than 0", "0");
  in.required("emission");
  out.emission = colour_or(in, "emission", out.emission, kNoLimit);
  out.from_frame = number_or(in, "fromFrame", 0.0);
  out.motion = read_rigid_motion(in);
  return out;
}

SceneComponents read_components(StrictObject& in) {
  SceneComponents out;
  const Json* list = in.optional("components");
  if (!list) return out;
  out = {false, false, false};
  if (!list->is_array())
    throw InputError(in.subject("components"), "must be an array", json_excerpt(*list));
  for (const Json& item : *list) {
    if (item == "visibility")
      out.visibility = true;
    else if (item == "glossy")
      out.glossy = true;
    else if (item == "indirect")
      out.indirect = true;
    else
      throw InputError(in.subject("components"), "must name visibility, glossy or indirect",
                       json_excerpt(item));
  }
  return out;
}

SceneCamera read_camera(StrictObject& parent) {
  StrictObject in = child(parent, "camera");
  SceneCamera camera;
  camera.vertical_fov_deg = positive_or(in, "verticalFovDeg", camera.vertical_fov_deg, 179.0);
  camera.near_m = positive_or(in, "near", camera.near_m);
  camera.far_m = positive_or(in, "far", camera.far_m);
  if (!(camera.far_m > camera.near_m))
    throw InputError(in.subject("far"), "must be greater than near", std::to_string(camera.far_m));
  camera.motion = read_rigid_motion(in);
  in.finish();
  return camera;
}

Scene read_top(StrictObject& in, const std::filesystem::path& folder) {
  const std::string format = in.text("format");
  if (format != "holdfast-scene")
    throw InputError(in.subject("format"), "must be holdfast-scene", shortened(format));
  in.integer("version", 1, 1);
  Scene scene;
  scene.name = in.text("name");
  scene.frame_rate = positive_or(in, "frameRate", scene.frame_rate);
  scene.components = read_components(in);
  if (in.optional("sky")) {
    StrictObject sky = child(in, "sky");
    scene.sky.horizon = colour_or(sky, "horizon", scene.sky.horizon, kNoLimit);
    scene.sky.zenith = colour_or(sky, "zenith", scene.sky.zenith, kNoLimit);
    sky.finish();
  }
  scene.ambient = colour_or(in, "ambient", scene.ambient, kNoLimit);
  scene.camera = read_camera(in);
  each(in, "objects", in.required("objects"),
       [&](StrictObject& item) { scene.objects.push_back(read_object(item, folder)); });
  if (const Json* lights = in.optional("lights"))
    each(in, "lights", *lights,
         [&](StrictObject& item) { scene.lights.push_back(read_light(item)); });
  in.finish();
  return scene;
}

Scene read_json(const Json& json, const std::filesystem::path& file) {
  StrictObject top(json, file.string(), "");
  return read_top(top, file.parent_path());
}

}  // namespace

Scene scene_from_json(const std::string& text, const std::filesystem::path& file) {
  return read_json(parse_json(text, file.string()), file);
}

Scene read_scene(const std::filesystem::path& file) {
  return read_json(read_json_file(file.string()), file);
}

}  // namespace holdfast::scenes
