#include "client/measure/comparison_text.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace holdfast::measure {
namespace {

/// JSON has no NaN and no infinity: null.
nlohmann::ordered_json number(double value) {
  if (std::isfinite(value)) return value;
  return nullptr;
}

nlohmann::ordered_json layer_json(const Comparison::Layer& layer, Region region) {
  const LayerErrors& errors = errors_of(layer, region);
  nlohmann::ordered_json json{{"measure", measure_text(layer.measure)},
                              {"rmse", number(errors.rmse)},
                              {"psnr", number(errors.psnr)},
                              {"ssim", number(errors.ssim)},
                              {"flip", number(errors.flip)},
                              {"flicker", number(errors.flicker)},
                              {"non_finite", errors.non_finite},
                              {"judged_pixels", errors.judged_pixels}};
  json["per_frame"] = nlohmann::ordered_json::array();
  for (const LayerErrors::Frame& frame : errors.per_frame)
    json["per_frame"].push_back({{"frame", frame.frame}, {"rmse", number(frame.rmse)}});
  return json;
}

}  // namespace

const char* region_name(Region region) { return region == Region::kImage ? "image" : "effect"; }

const LayerErrors& errors_of(const Comparison::Layer& layer, Region region) {
  return region == Region::kImage ? layer.image : layer.effect;
}

nlohmann::ordered_json comparison_json(const Comparison& comparison, Region region) {
  nlohmann::ordered_json json{{"frames", comparison.frames}, {"mask", region_name(region)}};
  json["layers"] = nlohmann::ordered_json::object();
  for (const Comparison::Layer& layer : comparison.layers)
    json["layers"][layer.name] = layer_json(layer, region);
  return json;
}

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "exact";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string comparison_table(const Comparison& comparison, Region region) {
  char line[256];
  std::snprintf(line, sizeof line, "%lld frames, mask: %s\n%-20s %9s %8s %8s %8s %9s %11s %10s\n",
                static_cast<long long>(comparison.frames), region_name(region), "layer", "RMSE",
                "PSNR dB", "SSIM", "FLIP", "flicker", "non-finite", "pixels");
  std::string out = line;
  for (const Comparison::Layer& layer : comparison.layers) {
    const LayerErrors& e = errors_of(layer, region);
    std::snprintf(line, sizeof line, "%-20s %9s %8s %8s %8s %9s %11lld %10lld\n",
                  layer.name.c_str(), number_text(e.rmse, 5).c_str(),
                  number_text(e.psnr, 2).c_str(), number_text(e.ssim, 4).c_str(),
                  number_text(e.flip, 4).c_str(), number_text(e.flicker, 5).c_str(),
                  static_cast<long long>(e.non_finite), static_cast<long long>(e.judged_pixels));
    out += line;
  }
  return out + "Visibility: " + measure_text(Measure::kClip) +
         "; radiance: " + measure_text(Measure::kTonemap) +
         "; FLIP: HDR-FLIP of radiance, LDR-FLIP of visibility. Sky excluded.\n";
}

}  // namespace holdfast::measure
