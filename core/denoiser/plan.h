#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"
#include "core/denoiser/preset.h"
#include "core/denoiser/recipe.h"

namespace holdfast {

/// What a configuration makes the denoiser run and hold: derived once, from the recipe, the preset
/// and the planes that frames bring. Nothing is run or held that the plan does not list.
struct Plan {
  struct Entry {
    Component component;
    bool has_footprint = false;   ///< samples say how smooth it is: blocker planes, or glossy hits
                                  ///< with roughness
    bool follows_effect = false;  ///< by a vector of its own, besides the surface's
    bool cones = false;           ///< kept by cones: the recipe asks for them and frames bring
                                  ///< directions
    bool gradients = false;       ///< the recipe asks for gradient samples and frames bring them
    bool half = false;            ///< filtered at half resolution
    bool leaves_out_unlit = false;  ///< of a visibility: what its light does not reach, unlit.h
    int turn = 0;                   ///< 0 .. rest_turns - 1: the frame of its turn at rest
  };
  /// What the components of one resolution need together.
  struct Grid {
    bool any = false;            ///< there is one
    bool any_radiance = false;   ///< one has three channels
    bool any_footprint = false;  ///< one has a footprint
    bool any_effect = false;     ///< one follows its effect
    bool any_visibility = false;
    bool any_cones = false;  ///< one is kept by cones
  };
  Recipe recipe;  ///< as the preset has it
  Preset preset;  ///< as the configuration has it
  std::vector<Entry> components;
  std::vector<std::uint32_t>
      shaded_lights;         ///< ids; unshadowed light that the core computes itself
  bool shaded_lobe = false;  ///< ... with a specular lobe
  bool history = false;      ///< the recipe keeps history at all
  HistoryFormat history_format = HistoryFormat::kNone;  ///< how
  Grid full, half;             ///< the components of the frame's own resolution, and of half of it
  bool any_gradients = false;  ///< a component has gradient samples
  bool roughness = false;      ///< roughness is kept with the guides
  bool motion = false;         ///< the client's motion vectors are kept with the guides
  int rest_turns = 1;          ///< frames of which a component at rest is filtered in one; 1: never
                               ///< passed over

  /// Checks `config` and derives its plan. Throws InputError naming what is wrong.
  static Plan make(const DenoiserConfig& config);

  /// What the history of a component holds besides signal and samples.
  HistoryExtras extras() const;
  /// The recipe of a component: at half resolution the same reach takes a level less.
  Recipe recipe_of(const Entry& entry) const;

  /// One pass a line, with the bytes that it moves for each pixel of the frame.
  std::string text() const;
};

}  // namespace holdfast
