#include "server/log.h"

#include <algorithm>
#include <array>

#include <spdlog/sinks/stdout_sinks.h>

#include "core/frame/error.h"

namespace holdfast::server {

std::shared_ptr<spdlog::logger> make_logger(const std::string& level) {
  constexpr std::array<const char*, 6> kLevels{"trace", "debug", "info", "warn", "error", "off"};
  if (std::find(kLevels.begin(), kLevels.end(), level) == kLevels.end())
    throw InputError("log level", "must be one of trace, debug, info, warn, error, off",
                     "\"" + level + "\"");
  auto logger = std::make_shared<spdlog::logger>("holdfast-server",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z level=%l %v");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::info);
  return logger;
}

}  // namespace holdfast::server
