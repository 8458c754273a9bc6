#include <cmath>

#include <nlohmann/json.hpp>

#include "client/cli/study_wire.h"
#include "client/measure/comparison_text.h"

namespace holdfast::cli {
namespace {

using measure::number_text;

nlohmann::ordered_json cost_json(const WireCost& cost) {
  return {{"plain_bytes_per_pixel", cost.plain_bytes},
          {"bytes_per_pixel", cost.coded_bytes},
          {"encode_ns_per_pixel", cost.encode_ns},
          {"decode_ns_per_pixel", cost.decode_ns}};
}

/// A number, or null where it is not finite.
nlohmann::ordered_json finite_json(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

std::string psnr_text(double psnr) {
  return std::isfinite(psnr) ? number_text(psnr, 1) : std::string("same");
}

std::string bytes_cells(const WireCost& cost) {
  return number_text(cost.plain_bytes, 1) + " | " + number_text(cost.coded_bytes, 1);
}

std::string rows_text(const std::vector<WireFigures>& figures) {
  std::string text =
      "| sequence | profile | up, bytes a pixel | with codec | down | with codec | encode up, ns "
      "a pixel | decode up | encode down | decode down |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const WireFigures& f : figures)
    text += "| " + f.sequence + " | `" + f.profile + "` | " + bytes_cells(f.up) + " | " +
            bytes_cells(f.down) + " | " + number_text(f.up.encode_ns, 1) + " | " +
            number_text(f.up.decode_ns, 1) + " | " + number_text(f.down.encode_ns, 1) + " | " +
            number_text(f.down.decode_ns, 1) + " |\n";
  return text;
}

std::string errors_text(const std::vector<WireFigures>& figures) {
  std::string text =
      "| sequence | profile | layer | PSNR against `exact`, dB | RMSE against references |\n"
      "|---|---|---|--:|--:|\n";
  for (const WireFigures& f : figures)
    for (const auto& [id, error] : f.layers)
      text += "| " + f.sequence + " | `" + f.profile + "` | " + plane_name(id) + " | " +
              psnr_text(error.psnr) + " | " +
              (std::isnan(error.reference_rmse) ? "" : number_text(error.reference_rmse, 5)) +
              " |\n";
  return text;
}

/// Bytes by plane, a column a profile, of the first sequence.
std::string planes_text(const std::vector<WireFigures>& figures) {
  std::vector<const WireFigures*> columns;
  for (const WireFigures& f : figures)
    if (f.sequence == figures.front().sequence) columns.push_back(&f);
  std::string text = "| plane |";
  for (const WireFigures* f : columns) text += " `" + f->profile + "` | with codec |";
  text += "\n|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "--:|--:|";
  text += "\n";
  const auto add = [&](const char* direction, auto member) {
    for (const auto& [id, unused] : columns.front()->*member) {
      text += "| " + plane_name(id) + direction + " |";
      for (const WireFigures* f : columns) text += " " + bytes_cells((f->*member).at(id)) + " |";
      text += "\n";
    }
  };
  add("", &WireFigures::planes_up);
  add(", result", &WireFigures::planes_down);
  return text;
}

}  // namespace

nlohmann::ordered_json wire_json(const std::vector<WireFigures>& figures) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const WireFigures& f : figures) {
    nlohmann::ordered_json row{{"sequence", f.sequence},
                               {"profile", f.profile},
                               {"up", cost_json(f.up)},
                               {"down", cost_json(f.down)}};
    for (const auto& [id, cost] : f.planes_up) row["planes_up"][plane_name(id)] = cost_json(cost);
    for (const auto& [id, cost] : f.planes_down)
      row["planes_down"][plane_name(id)] = cost_json(cost);
    for (const auto& [id, error] : f.layers)
      row["layers"][plane_name(id)] = {{"psnr", finite_json(error.psnr)},
                                       {"rmse", error.rmse},
                                       {"reference_rmse", finite_json(error.reference_rmse)}};
    out.push_back(std::move(row));
  }
  return {{"wire", std::move(out)}};
}

std::string wire_markdown(const std::vector<WireFigures>& figures) {
  return rows_text(figures) + "\n" + errors_text(figures) + "\nBytes a pixel by plane, " +
         figures.front().sequence + ":\n\n" + planes_text(figures);
}

}  // namespace holdfast::cli
