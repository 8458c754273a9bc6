#include "client/measure/trade_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "client/measure/report_plot.h"

namespace holdfast::measure {
namespace {

constexpr double kWidth = 760, kHeight = 460;
constexpr double kLeft = 76, kRight = 24, kTop = 46, kBottom = 54;
constexpr const char* kColours[] = {"#a3480f", "#2f5fa8", "#1f7a5c", "#7a4a9c",
                                    "#5a5a5a", "#8f6d00", "#a02c5a"};

std::string format(const char* pattern, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Maps times and errors to the view box.
struct Axes {
  double least_ms, most_ms, least_rmse, most_rmse;
  double x(double ms) const {
    return kLeft +
           std::log(ms / least_ms) / std::log(most_ms / least_ms) * (kWidth - kLeft - kRight);
  }
  double y(double rmse) const {
    return kHeight - kBottom -
           (rmse - least_rmse) / (most_rmse - least_rmse) * (kHeight - kTop - kBottom);
  }
};

Axes axes_of(const std::vector<TradePoint>& points) {
  const auto by_ms = [](const TradePoint& a, const TradePoint& b) { return a.ms < b.ms; };
  const auto by_rmse = [](const TradePoint& a, const TradePoint& b) { return a.rmse < b.rmse; };
  const auto [fast, slow] = std::minmax_element(points.begin(), points.end(), by_ms);
  const auto [good, bad] = std::minmax_element(points.begin(), points.end(), by_rmse);
  const double margin = std::max(0.08 * (bad->rmse - good->rmse), 0.01 * bad->rmse);
  return {fast->ms * 0.85, slow->ms * 1.3, std::max(good->rmse - margin, 0.0),
          bad->rmse + margin + 1e-9};
}

/// 1, 2 or 5 times a power of ten.
double round_step(double raw) {
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

std::string grid(const Axes& axes, bool relative) {
  std::string svg;
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  for (double power = std::pow(10.0, std::floor(std::log10(axes.least_ms))); power < axes.most_ms;
       power *= 10)
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
      const double ms = digit * power;
      if (ms < axes.least_ms || ms > axes.most_ms) continue;
      svg += format("<line x1=\"%.1f\" x2=\"%.1f\" y1=\"%.0f\" y2=\"%.0f\" stroke=\"#ddd\"/>",
                    axes.x(ms), axes.x(ms), kTop, bottom) +
             format("<text x=\"%.1f\" y=\"%.0f\" text-anchor=\"middle\">%g</text>", axes.x(ms),
                    bottom + 17, ms);
    }
  const double step = round_step((axes.most_rmse - axes.least_rmse) / 6);
  for (double rmse = std::ceil(axes.least_rmse / step) * step; rmse <= axes.most_rmse; rmse += step)
    svg += format("<line x1=\"%.0f\" x2=\"%.0f\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>", kLeft,
                  right, axes.y(rmse), axes.y(rmse)) +
           format("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%.4g</text>", kLeft - 8,
                  axes.y(rmse) + 4.5, rmse);
  svg += format("<path d=\"M%.0f %.0fV%.0fH%.0f\" fill=\"none\" stroke=\"#333\"/>", kLeft, kTop,
                bottom, right);
  svg += format("<text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">%s</text>", (kLeft + right) / 2,
                kHeight - 14,
                relative ? "processor time of a frame over that of balanced"
                         : "processor time of a frame, ms, one thread");
  return svg + format(
                   "<text transform=\"translate(18 %.0f) rotate(-90)\" "
                   "text-anchor=\"middle\">%s</text>",
                   (kTop + bottom) / 2,
                   relative ? "RMSE over that of balanced" : "RMSE of components");
}

std::string front_line(const TradeScene& scene, const Axes& axes) {
  std::string points;
  double before = axes.y(axes.most_rmse);
  for (const std::size_t k : pareto_front(scene.points, scene.points.front().recipe)) {
    const double x = axes.x(scene.points[k].ms), y = axes.y(scene.points[k].rmse);
    points += format("%.1f,%.1f %.1f,%.1f ", x, before, x, y);
    before = y;
  }
  points += format("%.1f,%.1f", kWidth - kRight, before);
  return "<polyline fill=\"none\" stroke=\"#333\" stroke-width=\"1.5\" "
         "stroke-dasharray=\"5 3\" points=\"" +
         points + "\"/>";
}

/// Where a name goes: beside its point, moved up or down until it meets no other.
struct Label {
  double x, y;
  std::string text, colour;
  bool strong;
  double width() const { return 7.6 * static_cast<double>(text.size()); }
};

/// A named point.
struct Spot {
  double x, y;
};

bool is_free(const Label& label, const std::vector<Label>& labels, const std::vector<Spot>& spots) {
  constexpr double kLine = 14, kRadius = 8;
  if (label.x < kLeft || label.x + label.width() > kWidth || label.y < kTop - 6 ||
      label.y > kHeight - kBottom - 2)
    return false;
  const bool over_label = std::any_of(labels.begin(), labels.end(), [&](const Label& other) {
    return std::abs(label.y - other.y) < kLine && label.x < other.x + other.width() &&
           other.x < label.x + label.width();
  });
  return !over_label && std::none_of(spots.begin(), spots.end(), [&](const Spot& spot) {
    return spot.x > label.x - kRadius && spot.x < label.x + label.width() + kRadius &&
           std::abs(spot.y - (label.y - 4.5)) < kRadius + 4;
  });
}

/// Puts a label where it is free: beside its point on the right or left, else above or below.
void place(std::vector<Label>& labels, const std::vector<Spot>& spots, Label label) {
  const Spot spot{label.x, label.y};
  for (const double shift : {0.0, -15.0, 15.0, -24.0, 24.0, -39.0, 39.0, -54.0, 54.0})
    for (const double beside : {10.0, -10 - label.width()}) {
      label.x = spot.x + beside;
      label.y = spot.y + 4.5 + shift;
      if (!is_free(label, labels, spots)) continue;
      labels.push_back(std::move(label));
      return;
    }
  labels.push_back(std::move(label));
}

std::string text_of(const Label& label) {
  return format(
             "<text x=\"%.1f\" y=\"%.1f\" style=\"fill:%s\"%s stroke=\"#fff\" stroke-width=\"3\" "
             "paint-order=\"stroke\">",
             label.x, label.y, label.colour.c_str(), label.strong ? " font-weight=\"600\"" : "") +
         escaped(label.text) + "</text>";
}

std::string dot(const TradePoint& point, const Axes& axes, const char* colour, bool named) {
  const std::string title = format("%s: %.4g, RMSE %.4g, %.0f B/pixel", point_name(point).c_str(),
                                   point.ms, point.rmse, point.bytes_per_pixel);
  return format(
             "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%d\" fill=\"%s\" fill-opacity=\"%s\" "
             "stroke=\"%s\"><title>",
             axes.x(point.ms), axes.y(point.rmse), named ? 6 : 4, colour, named ? "1" : "0.25",
             colour) +
         escaped(title) + "</title></circle>";
}

/// What a point is called where the recipe's other presets come to the same figures: all of them.
/// Empty if an earlier point has named it.
std::string shared_name(const TradeScene& scene, const TradePoint& point) {
  TradePoint named = point;
  named.presets.clear();
  for (const TradePoint& other : scene.points) {
    const bool same =
        other.recipe == point.recipe && other.ms == point.ms && other.rmse == point.rmse;
    if (!same || other.presets.empty()) continue;
    if (named.presets.empty() && &other != &point) return "";
    named.presets.insert(named.presets.end(), other.presets.begin(), other.presets.end());
  }
  return point_name(named);
}

}  // namespace

std::string trade_svg(const TradeScene& scene, bool relative) {
  if (scene.points.empty()) return "";
  const Axes axes = axes_of(scene.points);
  std::vector<std::string> recipes;
  std::vector<Label> labels;
  std::vector<Spot> spots;
  for (const TradePoint& point : scene.points)
    if (!point.presets.empty()) spots.push_back({axes.x(point.ms), axes.y(point.rmse)});
  std::string dots;
  for (const bool named : {false, true})  // what is named lies on top
    for (const TradePoint& point : scene.points) {
      auto recipe = std::find(recipes.begin(), recipes.end(), point.recipe);
      if (recipe == recipes.end()) recipe = recipes.insert(recipes.end(), point.recipe);
      const char* colour =
          kColours[static_cast<std::size_t>(recipe - recipes.begin()) % std::size(kColours)];
      if (point.presets.empty() == named) continue;
      dots += dot(point, axes, colour, named);
      const std::string name = named ? shared_name(scene, point) : "";
      if (!name.empty())
        place(labels, spots,
              {axes.x(point.ms), axes.y(point.rmse), name, colour,
               point.recipe == scene.points.front().recipe});
    }
  std::string svg = format(
                        "<svg class=\"trade\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 "
                        "%.0f %.0f\" width=\"%.0f\" "
                        "height=\"%.0f\" font-family=\"sans-serif\" role=\"img\" "
                        "aria-label=\"",
                        kWidth, kHeight, kWidth, kHeight) +
                    escaped("Time and error of " + scene.name) + "\">" +
                    format(
                        "<style>.trade text{fill:#222;font-size:14px}</style>"
                        "<rect width=\"%.0f\" height=\"%.0f\" fill=\"#fff\"/>"
                        "<text x=\"%.0f\" y=\"26\" font-weight=\"600\">",
                        kWidth, kHeight, kLeft) +
                    escaped(scene.name) + "</text>" + grid(axes, relative) +
                    front_line(scene, axes) + dots;
  for (const Label& label : labels) svg += text_of(label);
  return svg + "</svg>";
}

std::string trade_panels_svg(const TradeScene& scene, bool relative) {
  if (scene.points.empty()) return "";
  TradeScene alone = scene;
  alone.name += ", " + scene.points.front().recipe + " alone";
  std::erase_if(alone.points,
                [&](const TradePoint& p) { return p.recipe != scene.points.front().recipe; });
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
             "width=\"%.0f\" height=\"%.0f\"><g>",
             kWidth, 2 * kHeight, kWidth, 2 * kHeight) +
         trade_svg(scene, relative) + format("</g><g transform=\"translate(0 %.0f)\">", kHeight) +
         trade_svg(alone, relative) + "</g></svg>";
}

}  // namespace holdfast::measure
