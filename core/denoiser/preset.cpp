#include "core/denoiser/preset.h"

#include <algorithm>

#include "core/frame/error.h"

namespace holdfast {
namespace {

constexpr int kFewestMoreLevels = -3, kMostMoreLevels = 1;  // 4 levels: 1 .. kMostLevels

// Ours: a scene at rest then costs a third of a moving one at most, core/DESIGN.md. `fast` filters
// less, so that what remains of a frame at rest is more of it.
constexpr int kRestTurns = 5, kRestTurnsOfFast = 12, kMostRestTurns = 16;

constexpr RadianceBasis kBases[] = {RadianceBasis::kIrradiance, RadianceBasis::kConesLuminance,
                                    RadianceBasis::kConesColour};

std::vector<Preset> make_presets() {
  const Preset fast{.name = "fast",
                    .kernel_taps = 9,
                    .indirect_basis = RadianceBasis::kIrradiance,
                    .half_indirect = true,
                    .half_glossy = true,
                    .half_visibility = true,
                    .rest_turns = kRestTurnsOfFast};
  const Preset balanced{.name = "balanced", .rest_turns = kRestTurns};
  const Preset accurate{.name = "accurate", .indirect_basis = RadianceBasis::kConesColour};
  const Preset reference{.name = "reference", .oracle = true};
  return {fast, balanced, accurate, reference};
}

const Preset& preset_of_name(const std::string& name) {
  std::string names;
  for (const Preset& preset : all_presets()) {
    if (preset.name == name) return preset;
    names.append(names.empty() ? "" : ", ").append(preset.name);
  }
  throw InputError("preset", "must be one of " + names, "'" + name + "'");
}

RadianceBasis basis_of_name(const std::string& name) {
  std::string names;
  for (const RadianceBasis basis : kBases) {
    if (basis_name(basis) == name) return basis;
    names.append(names.empty() ? "" : ", ").append(basis_name(basis));
  }
  throw InputError("indirect basis", "must be one of " + names, "'" + name + "'");
}

void choose_basis(const DenoiserConfig& config, Preset& preset) {
  if (config.indirect_basis.empty()) return;
  preset.indirect_basis = basis_of_name(config.indirect_basis);
  const auto has = [&](PlaneKind kind) {
    return std::find(config.planes.begin(), config.planes.end(), PlaneId{kind, {}}) !=
           config.planes.end();
  };
  if (preset.indirect_basis != RadianceBasis::kIrradiance && has(PlaneKind::kIndirect) &&
      !has(PlaneKind::kIndirectDirection))
    throw InputError("indirect basis",
                     "must be irradiance without plane " +
                         plane_name({PlaneKind::kIndirectDirection, {}}) + " in the session",
                     "'" + config.indirect_basis + "'");
}

void choose_resolution(const DenoiserConfig& config, Preset& preset) {
  const std::vector<std::string>& names = config.half_resolution;
  if (names.empty()) return;
  preset.half_indirect = preset.half_glossy = preset.half_visibility = false;
  for (const std::string& name : names) {
    if (std::count(names.begin(), names.end(), name) > 1)
      throw InputError("half resolution of " + name, "must be listed once", "listed twice");
    if (name == "none") {
      if (names.size() > 1)
        throw InputError("half resolution of none", "must stand alone", "beside others");
    } else if (name == "indirect") {
      preset.half_indirect = true;
    } else if (name == "glossy") {
      preset.half_glossy = true;
    } else if (name == "visibility") {
      preset.half_visibility = true;
    } else {
      throw InputError("half resolution", "must be of indirect, glossy, visibility or none",
                       "'" + name + "'");
    }
  }
}

void choose_history(const DenoiserConfig& config, Preset& preset) {
  if (config.history.empty()) return;
  for (const HistoryFormat format : {HistoryFormat::kPacked, HistoryFormat::kFloat})
    if (config.history == history_name(format)) {
      preset.history = format;
      return;
    }
  throw InputError("history", "must be f16 or f32", "'" + config.history + "'");
}

void choose_filter(const DenoiserConfig& config, Preset& preset) {
  const int taps = config.kernel_taps;
  if (taps != 0 && taps != 9 && taps != 13 && taps != 25)
    throw InputError("kernel taps", "must be 9, 13 or 25, or 0 for the preset's",
                     std::to_string(taps));
  if (taps != 0) preset.kernel_taps = taps;
  if (config.more_levels < kFewestMoreLevels || config.more_levels > kMostMoreLevels)
    throw InputError("more levels", "must be in -3..1", std::to_string(config.more_levels));
  preset.more_levels += config.more_levels;
}

void choose_rest(const DenoiserConfig& config, Preset& preset) {
  if (config.rest_turns < 0 || config.rest_turns > kMostRestTurns)
    throw InputError("rest turns", "must be in 1..16, or 0 for the preset's",
                     std::to_string(config.rest_turns));
  if (config.rest_turns > 0) preset.rest_turns = config.rest_turns;
}

}  // namespace

const std::vector<Preset>& all_presets() {
  static const std::vector<Preset> presets = make_presets();
  return presets;
}

Preset find_preset(const DenoiserConfig& config) {
  Preset preset = preset_of_name(config.preset);
  choose_basis(config, preset);
  choose_resolution(config, preset);
  choose_history(config, preset);
  choose_filter(config, preset);
  choose_rest(config, preset);
  return preset;
}

void apply(const Preset& preset, bool force_basis, Recipe& recipe) {
  recipe.visibility_filter.taps = recipe.radiance_filter.taps = preset.kernel_taps;
  for (int* levels : {&recipe.radiance_filter.levels, &recipe.svgf_levels})
    *levels = std::max(*levels + preset.more_levels, 1);
  if (force_basis || recipe.indirect_basis != RadianceBasis::kIrradiance)
    recipe.indirect_basis = preset.indirect_basis;
}

std::vector<std::string> half_names(const Preset& preset) {
  std::vector<std::string> names;
  if (preset.half_indirect) names.emplace_back("indirect");
  if (preset.half_glossy) names.emplace_back("glossy");
  if (preset.half_visibility) names.emplace_back("visibility");
  return names;
}

const char* history_name(HistoryFormat format) {
  switch (format) {
    case HistoryFormat::kNone: return "none";
    case HistoryFormat::kPacked: return "f16";
    case HistoryFormat::kFloat: return "f32";
  }
  return "";
}

const char* basis_name(RadianceBasis basis) {
  switch (basis) {
    case RadianceBasis::kIrradiance: return "irradiance";
    case RadianceBasis::kConesLuminance: return "luminance-cones";
    case RadianceBasis::kConesColour: return "cones";
  }
  return "";
}

}  // namespace holdfast
