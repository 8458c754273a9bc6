#pragma once

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
/// line. Line k has the class "line c<k>", which the page's style colours. Empty without any point.
std::string plot_svg(const std::string& title, const std::vector<PlotLine>& lines);

/// Text made safe for HTML content and attributes.
std::string escaped(const std::string& text);

}  // namespace holdfast::measure
