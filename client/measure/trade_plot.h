#pragma once

#include <string>

#include "client/measure/trade.h"

namespace holdfast::measure {

/// An SVG that stands alone, dark on white: a point for each setting, time on a logarithmic x axis,
/// RMSE on y, one colour a recipe; the front of the first recipe is a line, and presets are named.
/// `relative`: both axes are ratios to "reliable balanced". Points are titled with name, time, RMSE
/// and bytes. Empty without points.
std::string trade_svg(const TradeScene& scene, bool relative);

/// That plot, and below it the same of the first recipe alone, whose settings lie close together.
std::string trade_panels_svg(const TradeScene& scene, bool relative);

}  // namespace holdfast::measure
