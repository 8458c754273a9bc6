#include "client/measure/vector_tables.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace holdfast::measure {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json region_json(const RegionFigures& region, ComponentKind kind) {
  Json out{{"pixels", region.pixels}, {"reference_rmse", number(region.reference_rmse)}};
  const auto vectors = vectors_of(kind);
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    const VectorFigures& figures = region.vectors[v];
    out["vectors"][std::string(vector_name(vectors[v]))] = {
        {"rmse_valid", number(figures.rmse_valid)},
        {"rmse_fallback", number(figures.rmse_fallback)},
        {"rmse_mean", number(figures.rmse_mean)},
        {"share_valid", number(figures.share_valid)}};
  }
  return out;
}

/// A way to measure, as a table.
struct Table {
  const char* title;
  Region region;
  double VectorFigures::*figure;
};

std::vector<Table> tables_of(ComponentKind kind) {
  const bool hidden = kind == ComponentKind::kIndirect;
  const Region region = hidden ? Region::kImage : Region::kEffect;
  const Table valid{"one sample, where all vectors lead somewhere", region,
                    &VectorFigures::rmse_valid};
  const Table fallback{"one sample, with fallback", region, &VectorFigures::rmse_fallback};
  const Table mean{"mean of all draws, with fallback", region, &VectorFigures::rmse_mean};
  const Table share{"share of pixels where the vector leads somewhere", region,
                    &VectorFigures::share_valid};
  if (hidden) return {valid, fallback, share};
  return {valid,
          fallback,
          mean,
          {"one sample, with fallback", Region::kImage, &VectorFigures::rmse_fallback},
          share};
}

std::string region_text(ComponentKind kind, Region region) {
  if (kind == ComponentKind::kIndirect) return "surfaces that were hidden";
  return region == Region::kEffect ? "where the effect moves" : "whole image";
}

std::string case_row(const VectorCase& row, const Table& table) {
  const RegionFigures& figures = table.region == Region::kImage ? row.image : row.effect;
  const bool errors = table.figure != &VectorFigures::share_valid;
  double best = std::nan("");
  for (const VectorFigures& v : figures.vectors)
    if (errors && !(v.*table.figure >= best)) best = v.*table.figure;
  const std::string least = number_text(best, 4);
  std::string out = "| " + row.scene + " |";
  if (row.component.kind == ComponentKind::kGlossy)
    out += " " + number_text(row.roughness.value_or(0), 2) + " |";
  for (const VectorFigures& v : figures.vectors) {
    const std::string text = number_text(v.*table.figure, errors ? 4 : 2);
    out += errors && text != "-" && text == least ? " **" + text + "** |" : " " + text + " |";
  }
  return out + "\n";
}

std::string table_text(const VectorStudy& study, ComponentKind kind, const Table& table) {
  const char* layer = kind == ComponentKind::kGlossy       ? "glossy"
                      : kind == ComponentKind::kVisibility ? "visibility"
                                                           : "indirect";
  std::string head = "| scene |", rule = "|---|";
  if (kind == ComponentKind::kGlossy) {
    head += " roughness |";
    rule += "---|";
  }
  for (const FollowedVector vector : vectors_of(kind)) {
    head += " " + std::string(vector_name(vector)) + " |";
    rule += "---|";
  }
  std::string out = std::string(layer) + ", " + region_text(kind, table.region) + ": " +
                    table.title + "\n\n" + head + "\n" + rule + "\n";
  for (const VectorCase& row : study.cases)
    if (row.component.kind == kind) out += case_row(row, table);
  return out;
}

bool has_kind(const VectorStudy& study, ComponentKind kind) {
  for (const VectorCase& row : study.cases)
    if (row.component.kind == kind) return true;
  return false;
}

}  // namespace

Json vector_json(const VectorStudy& study) {
  Json out{{"width", study.width}, {"height", study.height}, {"draws", study.draws}};
  out["cases"] = Json::array();
  for (const VectorCase& row : study.cases)
    out["cases"].push_back({{"scene", row.scene},
                            {"component", component_name(row.component)},
                            {"roughness", row.roughness ? Json(*row.roughness) : Json(nullptr)},
                            {"pairs", row.pairs},
                            {"effect", region_json(row.effect, row.component.kind)},
                            {"image", region_json(row.image, row.component.kind)}});
  return out;
}

std::string vector_markdown(const VectorStudy& study) {
  std::string out;
  for (const ComponentKind kind :
       {ComponentKind::kGlossy, ComponentKind::kVisibility, ComponentKind::kIndirect}) {
    if (!has_kind(study, kind)) continue;
    for (const Table& table : tables_of(kind))
      out += (out.empty() ? "" : "\n") + table_text(study, kind, table);
  }
  return out;
}

}  // namespace holdfast::measure
