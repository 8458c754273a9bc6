#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace holdfast::cli {

/// Writes a subcommand's `--json FILE`. Throws std::runtime_error if the file cannot be written.
inline void write_json_file(const std::string& file, const nlohmann::ordered_json& json) {
  std::ofstream stream(file);
  stream << json.dump(1) << '\n';
  if (!stream.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace holdfast::cli
