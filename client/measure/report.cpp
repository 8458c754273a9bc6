#include "client/measure/report.h"

#include <fstream>
#include <stdexcept>

#include "client/measure/report_assets.h"
#include "client/measure/report_pictures.h"
#include "client/measure/report_plot.h"
#include "client/measure/report_table.h"

namespace holdfast::measure {
namespace {

std::string options_html(const std::vector<NamedPicture>& pictures, const std::string& chosen) {
  std::string html;
  for (const NamedPicture& picture : pictures)
    html += "<option" + std::string(picture.name == chosen ? " selected" : "") + ">" +
            escaped(picture.name) + "</option>";
  return html;
}

/// The slider: two pictures on top of each other, chosen by drop-down lists.
std::string slider_html(const LayerPictures& layer) {
  const Picture& size = layer.pictures.front().picture;
  std::string html =
      "<div class=\"controls\"><label>left <select class=\"left\">" +
      options_html(layer.pictures, layer.pictures.front().name) +
      "</select></label><label>right <select class=\"right\">" +
      options_html(layer.pictures, layer.pictures[layer.pictures.size() - 2].name) +
      "</select></label><label><input type=\"checkbox\" class=\"errors\"> error map</label></div>"
      "<figure class=\"slider\" style=\"aspect-ratio:" +
      std::to_string(size.width) + "/" + std::to_string(size.height) +
      "\"><img class=\"left\" alt=\"\"><img class=\"right\" alt=\"\"><span class=\"bar\"></span>"
      "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.1\" "
      "aria-label=\"Boundary between the pictures\"></figure><div class=\"store\" hidden>";
  for (const NamedPicture& picture : layer.pictures)
    html += "<img data-name=\"" + escaped(picture.name) + "\" alt=\"\" src=\"" +
            png_data_uri(picture.picture) + "\"><img data-name=\"" + escaped(picture.name) +
            "\" data-error alt=\"\" src=\"" + png_data_uri(picture.error) + "\">";
  return html + "</div>";
}

std::string plot_html(const ReportScene& scene, std::size_t layer, bool effect) {
  std::vector<PlotLine> lines;
  for (const ReportResult& result : scene.results) {
    const Comparison::Layer& errors = result.comparison.layers[layer];
    lines.push_back({result.name, (effect ? errors.effect : errors.image).per_frame});
  }
  const std::string title =
      std::string("RMSE over frames, ") + (effect ? "where the effect moves" : "whole image");
  const std::string svg = plot_svg(title, lines);
  return svg.empty()
             ? ""
             : "<figure class=\"plot\"><figcaption>" + title + "</figcaption>" + svg + "</figure>";
}

std::string legend_html(const ReportScene& scene) {
  std::string html = "<p class=\"legend\">";
  std::size_t line = 0;
  for (const ReportResult& result : scene.results)
    html += "<span><i class=\"key c" + std::to_string(line++) + "\"></i>" + escaped(result.name) +
            "</span>";
  return html + "</p>";
}

void write_pngs(const std::filesystem::path& dir, const std::string& scene,
                const LayerPictures& layer) {
  for (const NamedPicture& picture : layer.pictures) {
    const std::string stem = scene + "." + layer.layer + "." + picture.name;
    write_png(dir / (stem + ".png"), picture.picture);
    write_png(dir / (stem + ".error.png"), picture.error);
  }
}

std::string scene_html(const ReportScene& scene, const std::filesystem::path& png_dir) {
  const auto pictures = scene_pictures(scene);
  std::string html = "<section><h2>" + escaped(scene.name) + "</h2><p>" + escaped(scene.caption) +
                     " Pictures: frame " + std::to_string(pictured_frame(scene)) +
                     ".</p><div class=\"tabs\" role=\"tablist\">";
  for (const LayerPictures& layer : pictures)
    html += "<button role=\"tab\">" + escaped(layer.layer) + "</button>";
  html += "</div>";
  for (const LayerPictures& layer : pictures) {
    if (!png_dir.empty()) write_pngs(png_dir, scene.name, layer);
    const auto& compared = scene.results.front().comparison.layers;
    std::size_t index = 0;
    while (compared[index].name != layer.layer) ++index;
    html += "<div class=\"layer\"><h3>" + escaped(layer.layer) + "</h3>" + slider_html(layer) +
            table_html(scene, index) + legend_html(scene) + "<div class=\"plots\">" +
            plot_html(scene, index, false) + plot_html(scene, index, true) + "</div></div>";
  }
  return html + "</section>";
}

}  // namespace

void write_report(const std::filesystem::path& file, const std::string& title,
                  const std::vector<ReportScene>& scenes, const std::filesystem::path& png_dir) {
  if (!png_dir.empty()) std::filesystem::create_directories(png_dir);
  std::ofstream stream(file);
  stream
      << "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>"
      << escaped(title) << "</title><style>" << kReportStyle << "</style></head><body><main><h1>"
      << escaped(title) << "</h1>" << kReportIntroduction;
  for (const ReportScene& scene : scenes) stream << scene_html(scene, png_dir);
  stream << "</main><script>" << kReportScript << "</script></body></html>\n";
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace holdfast::measure
