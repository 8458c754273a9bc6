#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace holdfast::cli {

/// Adds --preset, --indirect-basis, --half-resolution and --history, which the commands that filter
/// share. What they name is checked by the core, whose errors name what is accepted.
inline void add_preset_options(CLI::App& command, std::string& preset, std::string& indirect_basis,
                               std::vector<std::string>& half_resolution, std::string& history) {
  command
      .add_option("--preset", preset,
                  "fast, balanced, accurate or reference (double precision, slow)")
      ->capture_default_str();
  command.add_option("--indirect-basis", indirect_basis,
                     "irradiance, luminance-cones or cones; default: the preset's");
  command
      .add_option("--half-resolution", half_resolution,
                  "components filtered at half resolution, with commas between: indirect, glossy, "
                  "visibility; or none; default: the preset's")
      ->delimiter(',');
  command.add_option("--history", history,
                     "how histories are kept: f16 (16 bits a signal, 8 a statistic) or f32; "
                     "default: the preset's");
}

}  // namespace holdfast::cli
