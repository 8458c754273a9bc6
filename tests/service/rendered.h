#pragma once

#include <string>
#include <vector>

#include "client/scenes/builtin.h"
#include "client/scenes/renderer.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::test {

/// A rendered scene with all its planes: blockers, light samples, a light that moves.
struct Rendered {
  Rendered(const char* scene, const std::string& recipe, std::uint64_t seed, int count = 6) {
    scenes::RenderSettings settings;
    settings.width = 96;
    settings.height = 54;
    settings.seed = seed;
    settings.speed = 4;
    scenes::Renderer renderer(scenes::builtin_scene(scene), settings);
    config.width = settings.width;
    config.height = settings.height;
    config.lights = renderer.lights();
    config.recipe = recipe;
    for (int i = 0; i < count; ++i) frames.push_back(renderer.frame(i));
    for (const Plane& plane : frames.front().planes) config.planes.push_back(plane.id());
  }
  DenoiserConfig config;
  std::vector<Frame> frames;
};

}  // namespace holdfast::test
