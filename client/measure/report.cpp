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
///
/// `source(name, picture, is_error)` is the address of a picture.
std::string slider_html(const LayerPictures& layer, const auto& source) {
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
    html += "<img data-name=\"" + escaped(picture.name) + "\" alt=\"\" loading=\"lazy\" src=\"" +
            source(picture, false) + "\"><img data-name=\"" + escaped(picture.name) +
            "\" data-error alt=\"\" loading=\"lazy\" src=\"" + source(picture, true) + "\">";
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
    html +=
        "<span><i class=\"key " + line_class(line++) + "\"></i>" + escaped(result.name) + "</span>";
  return html + "</p>";
}

/// The file of a picture within the folder of pictures.
std::string png_name(const ReportScene& scene, const LayerPictures& layer,
                     const NamedPicture& picture, bool is_error) {
  return scene.name + "." + layer.layer + "." + picture.name + (is_error ? ".error.png" : ".png");
}

void write_pngs(const std::filesystem::path& dir, const ReportScene& scene,
                const LayerPictures& layer) {
  for (const NamedPicture& picture : layer.pictures) {
    write_png(dir / png_name(scene, layer, picture, false), picture.picture);
    write_png(dir / png_name(scene, layer, picture, true), picture.error);
  }
}

/// `links`: the folder of pictures as the page addresses it; empty = the page holds its pictures.
std::string scene_html(const ReportScene& scene, const std::filesystem::path& png_dir,
                       const std::string& links) {
  const auto pictures = scene_pictures(scene);
  std::string html = "<section><h2>" + escaped(scene.name) + "</h2><p>" + escaped(scene.caption) +
                     " Pictures: frame " + std::to_string(pictured_frame(scene)) +
                     ".</p><div class=\"tabs\" role=\"tablist\">";
  for (const LayerPictures& layer : pictures)
    html += "<button role=\"tab\">" + escaped(layer.layer) + "</button>";
  html += "</div>";
  for (const LayerPictures& layer : pictures) {
    if (!png_dir.empty()) write_pngs(png_dir, scene, layer);
    const auto source = [&](const NamedPicture& picture, bool is_error) {
      return links.empty() ? png_data_uri(is_error ? picture.error : picture.picture)
                           : escaped(links + "/" + png_name(scene, layer, picture, is_error));
    };
    const auto& compared = scene.results.front().comparison.layers;
    std::size_t index = 0;
    while (compared[index].name != layer.layer) ++index;
    html += "<div class=\"layer\"><h3>" + escaped(layer.layer) + "</h3>" +
            slider_html(layer, source) + table_html(scene, index) + legend_html(scene) +
            "<div class=\"plots\">" + plot_html(scene, index, false) +
            plot_html(scene, index, true) + "</div></div>";
  }
  return html + "</section>";
}

}  // namespace

double core_over_traditional(const ReportScene& scene, const ReportResult& result) {
  for (const ReportResult& other : scene.results)
    if (other.name == "traditional") return result.core_ms / other.core_ms;
  return std::numeric_limits<double>::quiet_NaN();
}

void write_report(const std::filesystem::path& file, const std::vector<ReportScene>& scenes,
                  const ReportOptions& options) {
  const std::filesystem::path& png_dir = options.png_dir;
  if (!png_dir.empty()) std::filesystem::create_directories(png_dir);
  const std::string links = options.link_pictures && !png_dir.empty()
                                ? png_dir.lexically_proximate(file.parent_path()).generic_string()
                                : "";
  std::ofstream stream(file);
  stream
      << "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>"
      << escaped(options.title) << "</title><style>" << kReportStyle
      << "</style></head><body><main><h1>" << escaped(options.title) << "</h1>"
      << kReportIntroduction << options.top_html;
  for (const ReportScene& scene : scenes) stream << scene_html(scene, png_dir, links);
  stream << "</main><script>" << kReportScript << "</script></body></html>\n";
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace holdfast::measure
