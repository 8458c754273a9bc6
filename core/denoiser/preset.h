#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/denoiser/denoiser.h"
#include "core/denoiser/recipe.h"

namespace holdfast {

/// A preset: how much of a recipe's work is done. Data, not code; any preset goes with any recipe,
/// and `balanced` takes every recipe as it is.
struct Preset {
  std::string name;
  int kernel_taps = 13;  ///< of the a-trous kernel: 9, 13 or 25 (spatial/adaptive_filter.h)
  RadianceBasis indirect_basis = RadianceBasis::kConesLuminance;  ///< of recipes that keep cones
  bool half_indirect = false;                     ///< indirect light is filtered at half resolution
  bool half_glossy = false;                       ///< reflections likewise
  bool half_visibility = false;                   ///< shadows of every light likewise
  HistoryFormat history = HistoryFormat::kFloat;  ///< of recipes that keep one, but for those that
                                                  ///< keep moments of the luminance, as floats
  bool oracle = false;  ///< in double, pixel by pixel, without the kernels (core/oracle): slow
  int more_levels = 0;  ///< of the a-trous filter of radiance, beside the recipe's
  int rest_turns = 1;   ///< components at rest are filtered once in so many frames; 1: in all.
                        ///< Of recipes that notice changes of light, and keep floats
};

/// All presets, fastest first; `reference` last, which is no choice of quality but what the others
/// are measured against.
const std::vector<Preset>& all_presets();

/// The preset of `config`, with what `config` chooses itself in place of it. Throws InputError for
/// a name that is unknown, listed twice, or "none" beside others, and for cones of indirect light
/// whose directions no frame brings.
Preset find_preset(const DenoiserConfig& config);

/// Puts the preset's choices into a recipe; `force_basis`: also if the recipe keeps no cones.
void apply(const Preset& preset, bool force_basis, Recipe& recipe);

/// Components at half resolution, as DenoiserConfig::half_resolution has them; empty: none.
std::vector<std::string> half_names(const Preset& preset);

/// Name of a format, as DenoiserConfig::history has it.
const char* history_name(HistoryFormat format);

/// Name of a basis, as DenoiserConfig::indirect_basis has it.
const char* basis_name(RadianceBasis basis);

}  // namespace holdfast
