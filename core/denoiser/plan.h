#pragma once

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
    bool follows_shadows = false;  ///< a visibility with blocker planes: shadow vectors, footprint
    bool gradients = false;        ///< the recipe asks for gradient samples and frames bring them
  };
  Recipe recipe;
  std::vector<Entry> components;
  bool history = false;       ///< the recipe keeps history at all
  bool any_radiance = false;  ///< a component has three channels
  bool any_shadow = false;    ///< a component follows shadows
  bool any_gradients = false;

  /// Checks `config` and derives its plan. Throws InputError naming what is wrong.
  static Plan make(const DenoiserConfig& config);

  /// One pass or buffer a line.
  std::string text() const;
};

}  // namespace holdfast
