#include <nlohmann/json.hpp>

#include "client/scenes/scene_json.h"

namespace holdfast::scenes {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

void put_transform(Json& out, const Transform& t) {
  const Transform identity;
  if (t.translation != identity.translation) out["translation"] = vector_json(t.translation);
  if (t.rotation != identity.rotation)
    out["rotation"] = Json::array({t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w});
  if (t.scale != identity.scale) out["scale"] = vector_json(t.scale);
}

const char* repeat_name(Repeat repeat) {
  switch (repeat) {
    case Repeat::kHold: return "hold";
    case Repeat::kLoop: return "loop";
    case Repeat::kMirror: return "mirror";
  }
  return "";
}

Json motion_json(const Motion& motion) {
  Json out = Json::object();
  if (motion.keys.size() == 1 && motion.keys.front().frame == 0.0) {
    put_transform(out, motion.keys.front().transform);
    return out;
  }
  out["repeat"] = repeat_name(motion.repeat);
  for (const Key& key : motion.keys) {
    Json& item = out["keys"].emplace_back(Json{{"frame", key.frame}});
    put_transform(item, key.transform);
    if (key.jump) item["jump"] = true;
  }
  return out;
}

Json part_json(const Part& part) {
  Json out;
  switch (part.shape) {
    case PartShape::kBox: out = {{"shape", "box"}, {"size", vector_json(part.size_m)}}; break;
    case PartShape::kQuad:
      out = {{"shape", "quad"}, {"size", Json::array({part.size_m.x, part.size_m.z})}};
      break;
    case PartShape::kSphere: out = {{"shape", "sphere"}, {"radius", part.radius_m}}; break;
    case PartShape::kCylinder:
      out = {{"shape", "cylinder"}, {"radius", part.radius_m}, {"height", part.height_m}};
      break;
    case PartShape::kMesh: out = {{"shape", "mesh"}, {"file", part.file.string()}}; break;
  }
  put_transform(out, part.placement);
  return out;
}

Json material_json(const Material& material) {
  Json out{{"albedo", vector_json(material.albedo)}};
  if (material.checker)
    out["checker"] = {{"albedo", vector_json(material.checker->albedo)},
                      {"size", material.checker->size_m}};
  out["roughness"] = material.roughness;
  out["specular"] = vector_json(material.specular);
  out["emission"] = vector_json(material.emission);
  return out;
}

Json object_json(const Object& object) {
  Json out{{"id", object.id},
           {"name", object.name},
           {"fromFrame", object.from_frame},
           {"material", material_json(object.material)},
           {"parts", Json::array()}};
  for (const Part& part : object.parts) out["parts"].push_back(part_json(part));
  out["motion"] = motion_json(object.motion);
  return out;
}

Json light_json(const SceneLight& light) {
  return {
      {"id", light.light.id},          {"shape", std::string(light_shape_name(light.light.shape))},
      {"width", light.light.width},    {"height", light.light.height},
      {"radius", light.light.radius},  {"emission", vector_json(light.emission)},
      {"fromFrame", light.from_frame}, {"motion", motion_json(light.motion)}};
}

}  // namespace

std::string scene_to_json(const Scene& scene) {
  Json out{{"format", "holdfast-scene"},
           {"version", 1},
           {"name", scene.name},
           {"frameRate", scene.frame_rate},
           {"components", Json::array()}};
  if (scene.components.visibility) out["components"].push_back("visibility");
  if (scene.components.glossy) out["components"].push_back("glossy");
  if (scene.components.indirect) out["components"].push_back("indirect");
  out["sky"] = {{"horizon", vector_json(scene.sky.horizon)},
                {"zenith", vector_json(scene.sky.zenith)}};
  out["ambient"] = vector_json(scene.ambient);
  out["camera"] = {{"verticalFovDeg", scene.camera.vertical_fov_deg},
                   {"near", scene.camera.near_m},
                   {"far", scene.camera.far_m},
                   {"motion", motion_json(scene.camera.motion)}};
  out["objects"] = Json::array();
  for (const Object& object : scene.objects) out["objects"].push_back(object_json(object));
  out["lights"] = Json::array();
  for (const SceneLight& light : scene.lights) out["lights"].push_back(light_json(light));
  return out.dump(1);
}

}  // namespace holdfast::scenes
