#pragma once

#include <filesystem>
#include <string>

#include "client/scenes/scene.h"

namespace holdfast::scenes {

/// A scene as JSON text. Reading it back gives the same scene; paths of meshes stay as they are.
std::string scene_to_json(const Scene& scene);

/// The scene of JSON text. `file` names it in messages; mesh paths are relative to its folder.
///
/// { "format": "holdfast-scene", "version": 1, "name": "fence", "frameRate": 30,
///   "components": ["visibility", "glossy", "indirect"],
///   "sky": { "horizon": RGB, "zenith": RGB }, "ambient": RGB,
///   "camera": { "verticalFovDeg": 36, "near": 0.05, "far": 1000, "motion": MOTION },
///   "objects": [ { "id": 1, "name": "ball", "fromFrame": 0, "motion": MOTION,
///                  "material": { "albedo": RGB, "checker": { "albedo": RGB, "size": 0.5 },
///                                "roughness": 0.3, "specular": RGB, "emission": RGB },
///                  "parts": [ { "shape": "sphere", "radius": 0.3, TRANSFORM } ] } ],
///   "lights":  [ { "id": 0, "shape": "rectangle", "width": 1, "height": 0.5, "radius": 0,
///                  "emission": RGB, "fromFrame": 0, "motion": MOTION } ] }
///
/// RGB        three numbers, or one for all three
/// parts      "box" with "size" [x, y, z]; "quad" with "size" [x, z]; "sphere" with "radius";
///            "cylinder" with "radius" and "height"; "mesh" with "file", an OBJ file
/// MOTION     TRANSFORM for an object at rest, or
///            { "repeat": "hold" | "loop" | "mirror", "keys": [ { "frame": 0, TRANSFORM } ] };
///            a key with "jump": true is reached at once
/// TRANSFORM  any of "translation": [x, y, z], "rotation": [x, y, z, w] or
///            "lookAt": [x, y, z] (local -Z towards that point), "scale": [x, y, z]
///
/// Required: format, version, name, camera, objects; an object's id and parts; a light's id, shape
/// and emission; a key's frame. Throws InputError that names file, key, rule and value; an unknown
/// key is an error.
Scene scene_from_json(const std::string& text, const std::filesystem::path& file);

/// Reads a scene file. Throws as `scene_from_json`.
Scene read_scene(const std::filesystem::path& file);

}  // namespace holdfast::scenes
