#include <cstdio>

#include <nlohmann/json.hpp>

#include "client/cli/bench.h"

namespace holdfast::cli {

nlohmann::ordered_json bench_json(const BenchResult& result) {
  nlohmann::ordered_json json = {{"isa", result.isa},
                                 {"threads", result.threads},
                                 {"width", result.width},
                                 {"height", result.height},
                                 {"stages", nlohmann::ordered_json::array()},
                                 {"frames", nlohmann::ordered_json::array()}};
  for (const BenchStage& s : result.stages)
    json["stages"].push_back({{"stage", s.stage},
                              {"ns_per_pixel", s.ns_per_pixel},
                              {"bytes_per_pixel", s.bytes_per_pixel},
                              {"reference_ns_per_pixel", s.reference_ns_per_pixel}});
  for (const BenchFrame& f : result.frames)
    json["frames"].push_back(
        {{"recipe", f.recipe}, {"preset", f.preset}, {"ms", f.ms}, {"rested", f.rested}});
  if (result.one_signal)
    json["one_signal"] = {{"us_per_pixel", result.one_signal->us_per_pixel},
                          {"reference_us_per_pixel", result.one_signal->reference_us_per_pixel}};
  if (result.limits)
    json["limits"] = {{"multiply_adds_per_ns", result.limits->multiply_adds_per_ns},
                      {"copy_gb_per_s", result.limits->copy_gb_per_s}};
  return json;
}

std::string bench_text(const BenchResult& result) {
  char line[160];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof line, values...);
    text += line;
  };
  add("%dx%d, %d threads, %s\n", result.width, result.height, result.threads, result.isa.c_str());
  add("%-32s %10s %10s %10s %8s\n", "stage", "ns/pixel", "scalar", "B/pixel", "GB/s");
  for (const BenchStage& s : result.stages)
    add("%-32s %10.3f %10.3f %10.0f %8.1f\n", s.stage.c_str(), s.ns_per_pixel,
        s.reference_ns_per_pixel, s.bytes_per_pixel, s.bytes_per_pixel / s.ns_per_pixel);
  for (const BenchFrame& f : result.frames)
    add("%-32s %10.1f ms a frame (%s), %.2f times %s\n", f.recipe.c_str(), f.ms, f.preset.c_str(),
        f.ms / result.frames.front().ms, result.frames.front().recipe.c_str());
  if (const auto& one = result.one_signal) {
    add("%-32s %10.4f us/pixel", "one signal, svgf, 4 levels", one->us_per_pixel);
    if (one->reference_us_per_pixel > 0)
      add("; scalar %.4f, %.1f times", one->reference_us_per_pixel,
          one->reference_us_per_pixel / one->us_per_pixel);
    text += "\n";
  }
  if (const auto& limits = result.limits)
    add("one thread of this machine: %.1f multiply-adds of floats/ns, %.1f GB/s copied\n",
        limits->multiply_adds_per_ns, limits->copy_gb_per_s);
  return text;
}

}  // namespace holdfast::cli
