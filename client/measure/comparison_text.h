#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "client/measure/compare.h"

namespace holdfast::measure {

/// Which pixels a table or a JSON file is about.
enum class Region { kImage, kEffect };

const char* region_name(Region region);  ///< "image", "effect"
const LayerErrors& errors_of(const Comparison::Layer& layer, Region region);

/// {"frames":N,"mask":"..","layers":{"light0.visibility":{"measure":"..","rmse":..,"psnr":..,"ssim":..,
/// "flip":..,"flicker":..,"non_finite":0,"judged_pixels":N,"per_frame":[{"frame":0,"rmse":..}]}}}.
/// Null stands for a number that does not exist: the PSNR of a perfect result, flicker without
/// consecutive references, FLIP that was not asked for, anything over no pixel.
nlohmann::ordered_json comparison_json(const Comparison& comparison, Region region);

/// A table for people, one line a layer, with a line that states the measures.
std::string comparison_table(const Comparison& comparison, Region region);

/// `digits` digits after the point; "-" for NaN, "exact" for infinity.
std::string number_text(double value, int digits);

}  // namespace holdfast::measure
