#pragma once

#include <string>

#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// The scene of a JSON file (anything that ends in ".json"), or the built-in scene of that name.
/// Throws InputError; for an unknown name it lists the names.
Scene load_scene(const std::string& name_or_file);

/// "fence, cylinder, ...".
std::string builtin_scene_names();

}  // namespace holdfast::scenes
