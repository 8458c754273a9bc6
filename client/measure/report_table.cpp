#include "client/measure/report_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/measure/comparison_text.h"
#include "client/measure/reference_noise.h"
#include "client/measure/report_plot.h"

namespace holdfast::measure {
namespace {

/// One column: what it shows and which direction is better.
struct Column {
  const char* name;
  double LayerErrors::*value;
  int digits;
  bool high_is_better;
};
constexpr std::array<Column, 5> kColumns{{{"RMSE", &LayerErrors::rmse, 4, false},
                                          {"PSNR dB", &LayerErrors::psnr, 2, true},
                                          {"SSIM", &LayerErrors::ssim, 4, true},
                                          {"FLIP", &LayerErrors::flip, 4, false},
                                          {"flicker", &LayerErrors::flicker, 4, false}}};

double value_of(const ReportResult& result, std::size_t layer, Region region,
                const Column& column) {
  return errors_of(result.comparison.layers[layer], region).*column.value;
}

/// The text of the column's best value; what reads the same is as good.
std::string best_text(const ReportScene& scene, std::size_t layer, Region region,
                      const Column& column) {
  double best = std::nan("");
  for (const ReportResult& result : scene.results) {
    const double value = value_of(result, layer, region, column);
    const bool better = column.high_is_better ? value > best : value < best;
    if (std::isnan(best) || better) best = value;
  }
  return number_text(best, column.digits);
}

std::string cells(const ReportScene& scene, const ReportResult& result, std::size_t layer,
                  Region region) {
  std::string html;
  for (const Column& column : kColumns) {
    const std::string text = number_text(value_of(result, layer, region, column), column.digits);
    const bool best =
        scene.results.size() > 1 && text != "-" && text == best_text(scene, layer, region, column);
    html += best ? "<td><b>" + text + "</b></td>" : "<td>" + text + "</td>";
  }
  return html;
}

/// What the references themselves are off by, and whether that matters; empty if not measured.
std::string references_note(const ReportScene& scene, std::size_t layer) {
  const std::string& name = scene.results.front().comparison.layers[layer].name;
  std::string text;
  for (const Region region : {Region::kImage, Region::kEffect})
    if (const auto check = check_references(scene, name, region))
      text += std::string(text.empty() ? "" : "; ") + number_text(check->noise, 5) +
              (region == Region::kImage ? " over the image" : " where the effect moves") +
              (check->sufficient ? "" : ", too much beside the best RMSE to rank the best results");
  return text.empty() ? ""
                      : "<p class=\"note\">RMSE of the references themselves: " + text + ".</p>";
}

}  // namespace

std::string table_html(const ReportScene& scene, std::size_t layer) {
  const bool timed = std::any_of(scene.results.begin(), scene.results.end(),
                                 [](const ReportResult& r) { return !std::isnan(r.core_ms); });
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th></th><th colspan=\"5\">whole image</th>"
      "<th colspan=\"5\">where the effect moves</th>" +
      std::string(timed ? "<th></th>" : "") + "</tr><tr><th>result</th>";
  for (int region = 0; region < 2; ++region)
    for (const Column& column : kColumns) html += std::string("<th>") + column.name + "</th>";
  html += std::string(timed ? "<th>core ms</th>" : "") + "</tr></thead><tbody>";
  std::size_t line = 0;
  for (const ReportResult& result : scene.results)
    html += "<tr><th><i class=\"key " + line_class(line++) + "\"></i>" + escaped(result.name) +
            "</th>" + cells(scene, result, layer, Region::kImage) +
            cells(scene, result, layer, Region::kEffect) +
            (timed ? "<td>" + number_text(result.core_ms, 2) + "</td>" : "") + "</tr>";
  html += "</tbody></table></div>" + references_note(scene, layer);
  if (scene.results.front().comparison.layers[layer].effect.judged_pixels == 0)
    html += "<p class=\"note\">No pixel of this layer moves by more than the threshold.</p>";
  return html;
}

}  // namespace holdfast::measure
