#include "client/measure/trade_text.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "client/measure/comparison_text.h"
#include "client/measure/report_assets.h"
#include "client/measure/report_plot.h"
#include "client/measure/trade_plot.h"

namespace holdfast::measure {
namespace {

bool on_front(const TradeScene& scene, std::size_t k) {
  const auto front = pareto_front(scene.points, scene.points[k].recipe);
  return std::find(front.begin(), front.end(), k) != front.end();
}

nlohmann::ordered_json point_json(const TradePoint& point) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const TradePoint::Stage& stage : point.stages) stages[stage.name] = stage.ms;
  return {{"name", point_name(point)},
          {"recipe", point.recipe},
          {"presets", point.presets},
          {"kernel_taps", point.kernel_taps},
          {"more_levels", point.more_levels},
          {"indirect_basis", point.basis},
          {"half_resolution", point.half},
          {"history", point.history},
          {"wire", point.wire},
          {"ms", point.ms},
          {"stages", stages},
          {"bytes_per_pixel", point.bytes_per_pixel},
          {"history_bytes_per_pixel", point.history_bytes_per_pixel},
          {"wire_bytes_per_pixel", point.wire_bytes_per_pixel},
          {"rmse", point.rmse},
          {"ssim", point.ssim},
          {"composite_rmse", point.composite_rmse}};
}

nlohmann::ordered_json scene_json(const TradeScene& scene) {
  nlohmann::ordered_json json = {{"caption", scene.caption},
                                 {"width", scene.width},
                                 {"height", scene.height},
                                 {"points", nlohmann::ordered_json::array()},
                                 {"wire", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < scene.points.size(); ++k) {
    nlohmann::ordered_json& point = json["points"].emplace_back(point_json(scene.points[k]));
    point["front"] = on_front(scene, k);
    point["rmse_behind_front"] = rmse_behind_front(scene.points, k);
  }
  for (const TradePoint& point : scene.wire_points) json["wire"].push_back(point_json(point));
  json["from_reference"] = nlohmann::ordered_json::object();
  for (const TradeScene::Deviation& deviation : scene.deviations)
    json["from_reference"][deviation.preset][deviation.layer] = {{"typical", deviation.typical},
                                                                 {"largest", deviation.largest}};
  return json;
}

/// Cells of the table's rows: named settings and the front's others, fastest first.
std::vector<std::vector<std::string>> rows_of(const TradeScene& scene, bool relative) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < scene.points.size(); ++k)
    if (!scene.points[k].presets.empty() || on_front(scene, k)) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return scene.points[a].ms < scene.points[b].ms;
  });
  std::vector<std::vector<std::string>> rows{{"setting", relative ? "time" : "ms", "B/pixel",
                                              "RMSE", "SSIM", "RMSE behind the front",
                                              "RMSE of the composite"}};
  for (const std::size_t k : order) {
    const TradePoint& point = scene.points[k];
    rows.push_back({point_name(point), number_text(point.ms, relative ? 3 : 1),
                    number_text(point.bytes_per_pixel, 0),
                    number_text(point.rmse, relative ? 3 : 4), number_text(point.ssim, 4),
                    on_front(scene, k)
                        ? "on it"
                        : number_text(100 * rmse_behind_front(scene.points, k), 1) + " %",
                    number_text(point.composite_rmse, relative ? 3 : 4)});
  }
  return rows;
}

/// The presets of the first recipe, each under every wire profile.
std::vector<std::vector<std::string>> wire_rows_of(const TradeScene& scene, bool relative) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const TradePoint& point) {
    rows.push_back({point_name(point), number_text(point.wire_bytes_per_pixel, 1),
                    number_text(point.rmse, relative ? 4 : 5),
                    number_text(point.composite_rmse, relative ? 4 : 5)});
  };
  for (const TradePoint& point : scene.points) {
    bool listed = false;
    for (const TradePoint& wired : scene.wire_points) {
      if (point.recipe != wired.recipe || point.presets != wired.presets) continue;
      if (!listed) add(point);
      listed = true;
      add(wired);
    }
  }
  if (!rows.empty())
    rows.insert(rows.begin(), {"setting and wire profile", "B/pixel on the wire", "RMSE",
                               "RMSE of the composite"});
  return rows;
}

/// How far presets are from `reference`.
std::vector<std::vector<std::string>> deviation_rows_of(const TradeScene& scene) {
  std::vector<std::vector<std::string>> rows;
  for (const TradeScene::Deviation& deviation : scene.deviations)
    rows.push_back({deviation.preset, deviation.layer, number_text(deviation.typical, 6),
                    number_text(deviation.largest, 4)});
  if (!rows.empty())
    rows.insert(rows.begin(), {"preset", "layer", "typical (RMS) difference from reference",
                               "largest difference"});
  return rows;
}

std::string table_markdown(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += "|";
    for (const std::string& cell : rows[r]) text += " " + cell + " |";
    text += "\n";
    if (r > 0) continue;
    text += "|---|";
    for (std::size_t c = 1; c < rows[r].size(); ++c) text += "---:|";
    text += "\n";
  }
  return text + "\n";
}

std::string table_html(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"wide\"><table>";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    html += "<tr>";
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const char* tag = r == 0 || c == 0 ? "th" : "td";
      html += std::string("<") + tag + ">" + escaped(rows[r][c]) + "</" + tag + ">";
    }
    html += "</tr>";
  }
  return html + "</table></div>";
}

std::string scene_markdown(const TradeScene& scene, bool relative) {
  std::string text = "**" + scene.name + "**: " + scene.caption + "\n\n" +
                     table_markdown(rows_of(scene, relative));
  if (!scene.wire_points.empty()) text += table_markdown(wire_rows_of(scene, relative));
  if (!scene.deviations.empty()) text += table_markdown(deviation_rows_of(scene));
  return text;
}

std::string scene_html(const TradeScene& scene, bool relative) {
  std::string html = "<section><h2>" + escaped(scene.name) + "</h2><p>" + escaped(scene.caption) +
                     ".</p><figure>" + trade_panels_svg(scene, relative) + "</figure>" +
                     table_html(rows_of(scene, relative));
  if (!scene.wire_points.empty()) html += table_html(wire_rows_of(scene, relative));
  if (!scene.deviations.empty()) html += table_html(deviation_rows_of(scene));
  return html + "</section>";
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// The scenes, after all of them as one if there are several.
template <class Write>
std::string each(const std::vector<TradeScene>& scenes, const Write& text_of) {
  std::string text;
  if (scenes.size() > 1) {
    const TradeScene all = trade_over_scenes(scenes);
    if (!all.points.empty()) text += text_of(all, true);
  }
  for (const TradeScene& scene : scenes) text += text_of(scene, false);
  return text;
}

}  // namespace

nlohmann::ordered_json trade_json(const std::vector<TradeScene>& scenes) {
  nlohmann::ordered_json json;
  for (const TradeScene& scene : scenes) json["scenes"][scene.name] = scene_json(scene);
  json["all"] = scene_json(trade_over_scenes(scenes));
  return json;
}

std::string trade_markdown(const std::vector<TradeScene>& scenes) {
  return each(scenes, scene_markdown);
}

void write_trade_report(const std::filesystem::path& file, const std::vector<TradeScene>& scenes) {
  write(file,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>Holdfast: speed and accuracy"
        "</title><style>" +
            std::string(kReportStyle) +
            "</style></head><body><main><h1>Holdfast: speed and accuracy</h1><p>Each point is one "
            "setting: its processor time and the RMSE of its components (their geometric mean). "
            "The dashed line is the "
            "front: what no other setting beats in both.</p>" +
            each(scenes, scene_html) + "</main></body></html>\n");
}

void write_trade_svg(const std::filesystem::path& file, const std::vector<TradeScene>& scenes) {
  const TradeScene all =
      scenes.size() > 1 ? trade_over_scenes(scenes) : TradeScene{{}, {}, 0, 0, {}, {}};
  write(file, (all.points.empty() ? trade_panels_svg(scenes.front(), false)
                                  : trade_panels_svg(all, true)) +
                  "\n");
}

}  // namespace holdfast::measure
