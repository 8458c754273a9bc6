#include "client/cli/load_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "client/cli/percentiles.h"

namespace holdfast::cli {
namespace {

constexpr double kWidth = 720, kHeight = 260;  // of the view box
constexpr double kLeft = 54, kRight = 22, kTop = 12, kBottom = 40;
constexpr std::size_t kFewestSpans = 8, kMostSpans = 60, kBars = 48;
constexpr std::size_t kSpanValues = 10;  // wanted in a span, so that percentiles differ

template <class... T>
std::string format(const char* pattern, T... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

/// 1, 2 or 5 times a power of ten, so that about `count` steps cover `extent`.
double step_of(double extent, int count) {
  const double raw = extent / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

/// Both axes begin at 0.
struct Axes {
  double right, top;
  double x(double value) const { return kLeft + value / right * (kWidth - kLeft - kRight); }
  double y(double value) const {
    return kHeight - kBottom - value / top * (kHeight - kTop - kBottom);
  }
};

std::string svg(const Axes& axes, const char* x_title, const std::string& inside) {
  std::string text = format("<svg viewBox=\"0 0 %.0f %.0f\" role=\"img\">", kWidth, kHeight);
  for (double v = 0, step = step_of(axes.top, 5); v <= axes.top * 1.001; v += step)
    text += format("<line class=\"grid\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\"/>", kLeft,
                   kWidth - kRight, axes.y(v), axes.y(v)) +
            format("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>", kLeft - 7,
                   axes.y(v) + 4, v);
  for (double v = 0, step = step_of(axes.right, 8); v <= axes.right * 1.001; v += step)
    text += format("<text x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%.4g</text>", axes.x(v),
                   kHeight - kBottom + 17, v);
  return text + inside +
         format("<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">%s</text></svg>",
                (kLeft + kWidth - kRight) / 2, kHeight - 4, x_title);
}

double rounded_up(double value, int count) {
  const double step = step_of(std::max(value, 1e-3), count);
  return std::ceil(std::max(value, 1e-3) / step) * step;
}

}  // namespace

std::string latency_over_time_svg(const std::vector<double>& at_s,
                                  const std::vector<double>& latency_ms) {
  if (latency_ms.empty()) return {};
  const double end = std::max(*std::max_element(at_s.begin(), at_s.end()), 1e-3);
  const std::size_t count = std::clamp(at_s.size() / kSpanValues, kFewestSpans, kMostSpans);
  std::vector<std::vector<double>> spans(count);
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    const auto span = static_cast<std::size_t>(at_s[i] / end * static_cast<double>(count));
    spans[std::min(span, count - 1)].push_back(latency_ms[i]);
  }
  const double top = *std::max_element(latency_ms.begin(), latency_ms.end());
  const Axes axes{end, rounded_up(top, 5)};
  std::string lines;
  const std::pair<const char*, double> kinds[] = {{"max", 1.0}, {"p95", 0.95}, {"p50", 0.5}};
  for (const auto& [name, fraction] : kinds) {
    std::string points;
    for (std::size_t i = 0; i < count; ++i)
      if (!spans[i].empty())
        points += format("%.1f,%.1f ",
                         axes.x((static_cast<double>(i) + 0.5) / static_cast<double>(count) * end),
                         axes.y(percentile(spans[i], fraction)));
    lines += format("<polyline class=\"line %s\" points=\"", name) + points + "\"><title>" + name +
             "</title></polyline>";
  }
  return svg(axes, "seconds", lines);
}

std::string latency_histogram_svg(const std::vector<double>& latency_ms) {
  if (latency_ms.empty()) return {};
  const double right = rounded_up(percentile(latency_ms, 0.995), 8);
  std::vector<double> bars(kBars);
  for (const double value : latency_ms) {
    const auto bar = static_cast<std::size_t>(value / right * kBars);
    ++bars[std::min(bar, kBars - 1)];
  }
  const Axes axes{right, rounded_up(*std::max_element(bars.begin(), bars.end()), 5)};
  std::string boxes;
  for (std::size_t i = 0; i < kBars; ++i) {
    const double low = static_cast<double>(i) / kBars * right, width = right / kBars;
    boxes += format("<rect class=\"bar\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\">",
                    axes.x(low) + 0.5, axes.y(bars[i]), axes.x(low + width) - axes.x(low) - 1,
                    axes.y(0) - axes.y(bars[i])) +
             format("<title>%.0f frames, %.4g to %.4g ms%s</title></rect>", bars[i], low,
                    low + width, i + 1 == kBars ? " and more" : "");
  }
  return svg(axes, "milliseconds", boxes);
}

}  // namespace holdfast::cli
