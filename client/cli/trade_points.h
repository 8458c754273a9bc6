#pragma once

#include <string>
#include <vector>

#include "client/measure/trade.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {

/// A setting to try.
struct TradeSetting {
  measure::TradePoint point;  ///< without figures
  DenoiserConfig config;      ///< of the scene
};

/// What a scene's sequence is tried with: every preset of each recipe but
/// `reference`, presets first; and of the
/// first recipe also every kernel and basis of indirect light at six choices of half resolution,
/// and one a-trous level less and more, and the other precision of histories, in each of its
/// presets. `scene`: size, lights and planes. Throws InputError for an unknown recipe.
std::vector<TradeSetting> trade_settings(const DenoiserConfig& scene,
                                         const std::vector<std::string>& recipes);

/// The presets of `recipe` again, under each wire profile but `exact`.
std::vector<TradeSetting> wire_settings(const DenoiserConfig& scene, const std::string& recipe);

}  // namespace holdfast::cli
