#pragma once

#include <string>

#include "tests/core/denoiser_world.h"

namespace holdfast::test {

/// A session under that preset with every plane that a component follows its effect by.
inline DenoiserConfig config_of(const std::string& preset, int width = 37, int height = 29) {
  DenoiserConfig config = full_config(width, height);
  for (const PlaneKind kind :
       {PlaneKind::kGlossyDirection, PlaneKind::kGlossyHitDistance, PlaneKind::kGlossyHitId,
        PlaneKind::kRoughness, PlaneKind::kIndirectDirection, PlaneKind::kMotion})
    config.planes.push_back({kind, {}});
  config.preset = preset;
  return config;
}

}  // namespace holdfast::test
