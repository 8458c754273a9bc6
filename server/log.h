#pragma once

#include <memory>
#include <string>

#include <spdlog/logger.h>

namespace holdfast::server {

/// A logger that writes "time level=.. message" lines to standard error; messages are key=value
/// pairs. Secrets (tokens) are never passed to it. Throws InputError for an unknown level.
std::shared_ptr<spdlog::logger> make_logger(const std::string& level);

}  // namespace holdfast::server
