#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/cli/load.h"
#include "client/cli/percentiles.h"

namespace holdfast::cli {
namespace {

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

template <class... T>
std::string printed(const char* format, T... values) {
  char text[256];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

}  // namespace

std::string load_sizes(const LoadOptions& options) {
  std::string text;
  for (const LoadSize& size : options.sizes)
    text +=
        (text.empty() ? "" : ",") + std::to_string(size.width) + "x" + std::to_string(size.height);
  return text;
}

nlohmann::ordered_json load_json(const LoadResult& result) {
  const LoadOptions& options = result.options;
  nlohmann::ordered_json ms, errors = nlohmann::ordered_json::object();
  for (const LoadPart& part : kLoadParts) {
    ms[part.name] = percentiles(result.times.*part.values);
    ms[part.name]["max"] = largest(result.times.*part.values);
  }
  for (const auto& [kind, count] : result.errors) errors[kind] = count;
  nlohmann::ordered_json json = {{"sessions", options.sessions},
                                 {"fps", options.fps},
                                 {"seconds", options.seconds},
                                 {"width", options.sizes.front().width},
                                 {"height", options.sizes.front().height},
                                 {"sizes", load_sizes(options)},
                                 {"delay_ms", options.link.delay_ms},
                                 {"bandwidth_mbit", options.link.bandwidth_mbit},
                                 {"churn_s", options.churn_s},
                                 {"clients", result.clients},
                                 {"recipe", options.recipe},
                                 {"preset", options.preset},
                                 {"wire", options.wire},
                                 {"submitted", result.submitted},
                                 {"answered", result.answered},
                                 {"dropped", result.dropped},
                                 {"skipped", result.skipped},
                                 {"late", result.late},
                                 {"frames_per_second", result.frames_per_second()},
                                 {"elapsed_s", result.elapsed_s},
                                 {"bytes_in", result.bytes_in},
                                 {"bytes_out", result.bytes_out},
                                 {"reconnects", result.reconnects},
                                 {"errors", errors},
                                 {"ms", ms}};
  if (!options.access.shared_memory.empty())
    json["shared_memory"] = {{"asked", true}, {"clients", result.sharing}};
  return json;
}

std::string load_text(const LoadResult& result) {
  const LoadOptions& options = result.options;
  const std::string rate =
      options.fps > 0 ? printed("%g frames/s each", options.fps) : std::string("closed loop");
  std::string text =
      printed("%d sessions of ", options.sessions) + load_sizes(options) +
      printed(", %s, %s (%s)\n", rate.c_str(), options.recipe.c_str(), options.preset.c_str());
  if (!options.link.plain())
    text += printed("over a link with %g ms one way and %g Mbit/s (0: no limit)\n",
                    options.link.delay_ms, options.link.bandwidth_mbit);
  if (options.churn_s > 0)
    text += printed("each client left after %g s: %lld sessions in all\n", options.churn_s,
                    static_cast<long long>(result.clients));
  if (!options.access.shared_memory.empty())
    text += printed(
        "shared memory: %lld of %lld clients%s\n", static_cast<long long>(result.sharing),
        static_cast<long long>(result.clients),
        result.sharing < result.clients ? "; planes of the others went through the stream" : "");
  text += printed("answered %lld of %lld frames, %.1f frames/s, %.1f MB/s in, %.1f MB/s out\n",
                  static_cast<long long>(result.answered), static_cast<long long>(result.submitted),
                  result.frames_per_second(),
                  1e-6 * static_cast<double>(result.bytes_in) / std::max(result.elapsed_s, 1e-9),
                  1e-6 * static_cast<double>(result.bytes_out) / std::max(result.elapsed_s, 1e-9));
  if (options.latest || options.deadline_ms > 0)
    text += printed("dropped %lld, left out %lld, beyond their deadline %lld\n",
                    static_cast<long long>(result.dropped), static_cast<long long>(result.skipped),
                    static_cast<long long>(result.late));
  text += printed("%-10s %9s %9s %9s %9s\n", "ms", "p50", "p95", "p99", "max");
  for (const LoadPart& part : kLoadParts) {
    const std::vector<double>& values = result.times.*part.values;
    text += printed("%-10s %9.2f %9.2f %9.2f %9.2f\n", part.name, percentile(values, 0.50),
                    percentile(values, 0.95), percentile(values, 0.99), largest(values));
  }
  for (const auto& [kind, count] : result.errors)
    text += printed("errors: %s %lld\n", kind.c_str(), static_cast<long long>(count));
  if (result.reconnects > 0)
    text += printed("reconnects: %lld\n", static_cast<long long>(result.reconnects));
  return text;
}

}  // namespace holdfast::cli
