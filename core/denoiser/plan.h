#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"
#include "core/denoiser/recipe.h"

namespace holdfast {

/// What a configuration makes the denoiser run and hold: derived once, from the recipe and the
/// planes that frames bring. Nothing is run or held that the plan does not list.
struct Plan {
  struct Entry {
    Component component;
    bool has_footprint = false;   ///< samples say how smooth it is: blocker planes, or glossy hits
                                  ///< with roughness
    bool follows_effect = false;  ///< by a vector of its own, besides the surface's
    bool cones = false;           ///< kept by cones: the recipe asks for them and frames bring
                                  ///< directions
    bool gradients = false;       ///< the recipe asks for gradient samples and frames bring them
  };
  Recipe recipe;
  std::vector<Entry> components;
  std::vector<std::uint32_t>
      shaded_lights;           ///< ids; unshadowed light that the core computes itself
  bool shaded_lobe = false;    ///< ... with a specular lobe
  bool history = false;        ///< the recipe keeps history at all
  bool any_radiance = false;   ///< a component has three channels
  bool any_footprint = false;  ///< a component has a footprint
  bool any_effect = false;     ///< a component follows its effect
  bool any_gradients = false;  ///< a component has gradient samples
  bool roughness = false;      ///< roughness is kept with the guides
  bool motion = false;         ///< the client's motion vectors are kept with the guides

  /// Checks `config` and derives its plan. Throws InputError naming what is wrong.
  static Plan make(const DenoiserConfig& config);

  /// One pass or buffer a line.
  std::string text() const;
};

}  // namespace holdfast
