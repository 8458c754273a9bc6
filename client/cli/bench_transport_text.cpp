#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/cli/bench_transport.h"

namespace holdfast::cli {

nlohmann::ordered_json transport_json(const TransportResult& result) {
  nlohmann::ordered_json json = {{"width", result.options.width},
                                 {"height", result.options.height},
                                 {"wire", result.options.wire},
                                 {"delay_ms", result.options.delay_ms},
                                 {"frames", result.options.frames},
                                 {"rounds", result.options.rounds},
                                 {"up_bytes", result.up_bytes},
                                 {"down_bytes", result.down_bytes},
                                 {"links", nlohmann::ordered_json::array()}};
  for (const LinkResult& link : result.links)
    json["links"].push_back({{"link", link.link},
                             {"raw_gb_per_s", link.raw_gb_per_s},
                             {"session_gb_per_s", link.session_gb_per_s},
                             {"ratio", link.ratio},
                             {"raw_cpu_s_per_gb", link.raw_cpu_s_per_gb},
                             {"session_cpu_s_per_gb", link.session_cpu_s_per_gb},
                             {"memory_frames", link.memory_frames}});
  return json;
}

std::string transport_text(const TransportResult& result) {
  char line[160];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof line, values...);
    text += line;
  };
  add("%dx%d, %s, %.1f MiB up, %.1f MiB down a frame\n", result.options.width,
      result.options.height, result.options.wire.c_str(),
      static_cast<double>(result.up_bytes) / (1 << 20),
      static_cast<double>(result.down_bytes) / (1 << 20));
  add("%-8s %12s %12s %8s %14s %14s %14s\n", "link", "raw GB/s", "session", "ratio", "raw CPU s/GB",
      "session", "memory, frames");
  for (const LinkResult& link : result.links)
    add("%-8s %12.2f %12.2f %8.2f %14.2f %14.2f %14.1f\n", link.link.c_str(), link.raw_gb_per_s,
        link.session_gb_per_s, link.ratio, link.raw_cpu_s_per_gb, link.session_cpu_s_per_gb,
        link.memory_frames);
  return text;
}

}  // namespace holdfast::cli
