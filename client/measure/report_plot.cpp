#include "client/measure/report_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace holdfast::measure {
namespace {

constexpr double kWidth = 640, kHeight = 260;  // of the view box
constexpr double kLeft = 52, kRight = 12, kTop = 12, kBottom = 34;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// 1, 2 or 5 times a power of ten, so that about `count` steps cover `extent`.
double step_of(double extent, int count) {
  const double raw = extent / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

std::string format(const char* pattern, auto... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Maps frames and errors to the view box.
struct Axes {
  Range frames;
  double top;
  double x(double frame) const {
    const double extent = std::max(frames.high - frames.low, 1.0);
    return kLeft + (frame - frames.low) / extent * (kWidth - kLeft - kRight);
  }
  double y(double error) const {
    return kHeight - kBottom - error / top * (kHeight - kTop - kBottom);
  }
};

std::string grid(const Axes& axes) {
  std::string svg;
  const double error_step = step_of(axes.top, 5);
  for (double error = 0; error <= axes.top * 1.001; error += error_step)
    svg += format("<line class=\"grid\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\"/>", kLeft,
                  kWidth - kRight, axes.y(error), axes.y(error)) +
           format("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%.3g</text>", kLeft - 6,
                  axes.y(error) + 4, error);
  const double frame_step =
      std::max(1.0, step_of(std::max(axes.frames.high - axes.frames.low, 1.0), 8));
  for (double frame = std::ceil(axes.frames.low / frame_step) * frame_step;
       frame <= axes.frames.high; frame += frame_step)
    svg += format("<text x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%.0f</text>", axes.x(frame),
                  kHeight - kBottom + 16, frame);
  return svg + format("<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">frame</text>",
                      (kLeft + kWidth - kRight) / 2, kHeight - 3);
}

}  // namespace

std::string plot_svg(const std::string& title, const std::vector<PlotLine>& lines) {
  Range frames, errors;
  for (const PlotLine& line : lines)
    for (const auto& point : line.points) {
      frames.include(static_cast<double>(point.frame));
      errors.include(point.rmse);
    }
  if (!(frames.low <= frames.high)) return "";
  const double highest = std::max(errors.high, 1e-6);
  const double step = step_of(highest, 5);
  const Axes axes{frames, std::ceil(highest / step) * step};

  std::string svg =
      format("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"", kWidth, kHeight) +
      escaped(title) + "\">" + grid(axes);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    svg += "<polyline class=\"line " + line_class(k) + "\" points=\"";
    for (const auto& point : lines[k].points)
      svg += format("%.1f,%.1f ", axes.x(static_cast<double>(point.frame)), axes.y(point.rmse));
    svg += "\"><title>" + escaped(lines[k].name) + "</title></polyline>";
  }
  return svg + "</svg>";
}

std::string line_class(std::size_t line) { return "c" + std::to_string(line % kLineColors); }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  return out;
}

}  // namespace holdfast::measure
