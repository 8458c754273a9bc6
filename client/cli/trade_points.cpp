#include "client/cli/trade_points.h"

#include <algorithm>

#include "core/denoiser/preset.h"
#include "core/denoiser/recipe.h"
#include "proto/wire_profile.h"

namespace holdfast::cli {
namespace {

constexpr RadianceBasis kBases[] = {RadianceBasis::kIrradiance, RadianceBasis::kConesLuminance,
                                    RadianceBasis::kConesColour};

/// At half resolution: indirect light, reflections, shadows.
constexpr bool kHalves[][3] = {{true, true, true},   {true, true, false},  {true, false, false},
                               {false, true, false}, {false, false, true}, {false, false, false}};

TradeSetting setting_of(const DenoiserConfig& scene, const std::string& recipe,
                        const Preset& parts) {
  TradeSetting setting;
  setting.point.recipe = recipe;
  setting.point.kernel_taps = parts.kernel_taps;
  setting.point.more_levels = parts.more_levels;
  setting.point.basis = basis_name(parts.indirect_basis);
  setting.point.half = half_names(parts);
  setting.point.history = history_name(parts.history);
  setting.config = scene;
  setting.config.recipe = recipe;
  return setting;
}

/// Without the name of a preset.
TradeSetting free_setting(const DenoiserConfig& scene, const std::string& recipe,
                          const Preset& parts) {
  TradeSetting setting = setting_of(scene, recipe, parts);
  DenoiserConfig& config = setting.config;
  config.preset = "balanced";
  config.kernel_taps = parts.kernel_taps;
  config.more_levels = parts.more_levels - find_preset(scene).more_levels;
  config.indirect_basis = basis_name(parts.indirect_basis);
  config.half_resolution = half_names(parts);
  if (config.half_resolution.empty()) config.half_resolution.push_back("none");
  config.history = history_name(parts.history);
  return setting;
}

bool same_parts(const measure::TradePoint& a, const measure::TradePoint& b) {
  return a.recipe == b.recipe && a.kernel_taps == b.kernel_taps && a.more_levels == b.more_levels &&
         a.basis == b.basis && a.half == b.half && a.history == b.history;
}

void add_once(std::vector<TradeSetting>& settings, TradeSetting setting) {
  if (std::none_of(settings.begin(), settings.end(), [&](const TradeSetting& other) {
        return same_parts(other.point, setting.point);
      }))
    settings.push_back(std::move(setting));
}

void add_sweep(const DenoiserConfig& scene, const std::string& recipe,
               std::vector<TradeSetting>& settings) {
  for (const int taps : {9, 13, 25})
    for (const RadianceBasis basis : kBases) {
      Preset parts{.name = {}, .kernel_taps = taps, .indirect_basis = basis};
      for (const auto& [indirect, glossy, visibility] : kHalves) {
        parts.half_indirect = indirect;
        parts.half_glossy = glossy;
        parts.half_visibility = visibility;
        add_once(settings, free_setting(scene, recipe, parts));
      }
    }
  for (const Preset& preset : all_presets())
    for (const int more : {-1, 1}) {
      Preset other = preset;
      other.more_levels += more;
      add_once(settings, free_setting(scene, recipe, other));
    }
  for (Preset preset : all_presets()) {
    preset.history =
        preset.history == HistoryFormat::kPacked ? HistoryFormat::kFloat : HistoryFormat::kPacked;
    add_once(settings, free_setting(scene, recipe, preset));
  }
}

std::vector<TradeSetting> preset_settings(const DenoiserConfig& scene, const std::string& recipe) {
  std::vector<TradeSetting> settings;
  for (const Preset& preset : all_presets()) {
    if (preset.oracle) continue;  // the error of `balanced`, at ten times the time
    TradeSetting setting = setting_of(scene, recipe, preset);
    setting.point.presets = {preset.name};
    setting.config.preset = preset.name;
    settings.push_back(std::move(setting));
  }
  return settings;
}

}  // namespace

std::vector<TradeSetting> trade_settings(const DenoiserConfig& scene,
                                         const std::vector<std::string>& recipes) {
  std::vector<TradeSetting> settings;
  for (const std::string& recipe : recipes) {
    find_recipe(recipe);
    for (TradeSetting& setting : preset_settings(scene, recipe))
      settings.push_back(std::move(setting));
    if (recipe == recipes.front()) add_sweep(scene, recipe, settings);
  }
  return settings;
}

std::vector<TradeSetting> wire_settings(const DenoiserConfig& scene, const std::string& recipe) {
  std::vector<TradeSetting> settings;
  for (const TradeSetting& preset : preset_settings(scene, recipe))
    for (const std::string& profile : wire::profile_names()) {
      if (profile == wire::exact_profile().name) continue;
      settings.push_back(preset);
      settings.back().point.wire = profile;
    }
  return settings;
}

}  // namespace holdfast::cli
