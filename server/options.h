#pragma once

#include <CLI/CLI.hpp>

#include "server/config.h"

namespace holdfast::server {

/// Adds every knob of `config` to `app`: as a flag, as an environment variable (HOLDFAST_ and the
/// flag's name), and as a key of the file that --config names. A flag goes before the file, and the
/// file before the environment. An unknown key is an error.
void add_options(CLI::App& app, ServerConfig& config);

/// The configuration as the text of such a file; secrets are in files and appear by name only.
std::string options_text(const CLI::App& app);

}  // namespace holdfast::server
