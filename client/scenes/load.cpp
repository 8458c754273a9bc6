#include "client/scenes/load.h"

#include "client/scenes/builtin.h"
#include "client/scenes/scene_json.h"

namespace holdfast::scenes {

Scene load_scene(const std::string& name_or_file) {
  if (name_or_file.ends_with(".json")) return read_scene(name_or_file);
  return builtin_scene(name_or_file);
}

std::string builtin_scene_names() {
  std::string names;
  for (const BuiltinScene& scene : builtin_scenes())
    names += (names.empty() ? "" : ", ") + std::string(scene.name);
  return names;
}

}  // namespace holdfast::scenes
