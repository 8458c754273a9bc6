#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/measure/layer_meter.h"

namespace holdfast::measure {

/// One line of a plot.
struct PlotLine {
  std::string name;
  std::vector<LayerErrors::Frame> points;
};

/// RMSE over frames as an inline SVG: one polyline a result, with axes, ticks and a title for each
/// line. Line k has the classes "line" and line_class(k). Empty without any point.
std::string plot_svg(const std::string& title, const std::vector<PlotLine>& lines);

/// Colours that the page's style knows; further lines begin anew.
inline constexpr std::size_t kLineColors = 12;

/// The class of line `line` and of its key, which the page's style colours.
std::string line_class(std::size_t line);

/// Text made safe for HTML content and attributes.
std::string escaped(const std::string& text);

}  // namespace holdfast::measure
