#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "client/scenes/renderer.h"

namespace holdfast::cli {

/// How a scene is rendered into a sequence.
struct RenderOptions {
  std::string scene;               ///< built-in name or scene JSON file
  std::filesystem::path out;       ///< folder of the sequence
  std::filesystem::path describe;  ///< also write the scene as JSON to this file; empty = do not
  std::int64_t frames = 24;
  std::int64_t reference_every = 1;  ///< a reference for every k-th frame ...
  bool reference_pairs = false;      ///< ... or for the last two of every k
  scenes::RenderSettings settings;   ///< reference_spp = 0: no references
  bool quiet = false;                ///< no progress
};

/// Where the time went.
struct RenderResult {
  std::string scene;  ///< its name
  double noisy_s = 0, reference_s = 0, write_s = 0;
};

/// Ray-traces a scene into a sequence with progress on standard error. Throws InputError for a bad
/// scene or setting, std::runtime_error if a file cannot be written.
RenderResult render_sequence(const RenderOptions& options);

}  // namespace holdfast::cli
