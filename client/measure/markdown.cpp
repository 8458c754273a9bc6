#include "client/measure/markdown.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "client/measure/claims_text.h"
#include "client/measure/reference_noise.h"

namespace holdfast::measure {
namespace {

/// One layer on one mask; two columns.
struct Group {
  std::size_t layer;
  std::string name;
  Region region;
};

/// The composite over the image, then each component where it moves.
std::vector<Group> groups_of(const ReportScene& scene) {
  std::vector<Group> groups;
  const auto& layers = scene.results.front().comparison.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const bool composite = plane_from_name(layers[i].name)->kind == PlaneKind::kComposite;
    const bool moves = !composite && layers[i].effect.judged_pixels > 0;
    groups.push_back({i, layers[i].name, moves ? Region::kEffect : Region::kImage});
  }
  return groups;
}

/// A column: the text of each result and which of them is best; "-" is never best.
struct Column {
  std::vector<std::string> cells;
  std::string best = "-";
};

template <class Value>
Column column(const ReportScene& scene, int digits, bool high_is_better, const Value& value) {
  Column out;
  double best = std::nan("");
  for (const ReportResult& result : scene.results) {
    const double number = value(result);
    out.cells.push_back(number_text(number, digits));
    if (std::isnan(best) || (high_is_better ? number > best : number < best)) {
      best = number;
      out.best = out.cells.back();
    }
  }
  return out;
}

const LayerErrors& errors_of(const ReportResult& result, const Group& group) {
  return errors_of(result.comparison.layers[group.layer], group.region);
}

std::string references_row(const ReportScene& scene, const std::vector<Group>& groups) {
  std::string row = "| references |";
  for (const Group& group : groups) {
    const auto check = check_references(scene, group.name, group.region);
    row += check ? " " + number_text(check->noise, 4) + (check->sufficient ? "" : "*") + " | |"
                 : " | |";
  }
  return scene.reference_noise.empty() ? "" : row + " |\n";
}

std::string cost_text(const ReportScene& scene, const ReportResult& result) {
  const double over = core_over_traditional(scene, result);
  return number_text(result.core_ms, 1) +
         (std::isnan(over) ? "" : " (" + number_text(over, 2) + ")");
}

std::string scene_markdown(const ReportScene& scene) {
  const std::vector<Group> groups = groups_of(scene);
  std::vector<Column> columns;
  std::string head = "| `" + scene.name + "` |", rule = "|---|";
  for (const Group& group : groups) {
    const std::string name = group.name + (group.region == Region::kImage ? ", image" : ", effect");
    head += " " + name + ": RMSE | SSIM |";
    rule += "---|---|";
    columns.push_back(
        column(scene, 4, false, [&](const auto& result) { return errors_of(result, group).rmse; }));
    columns.push_back(
        column(scene, 4, true, [&](const auto& result) { return errors_of(result, group).ssim; }));
  }
  std::string out = head + " core ms (over traditional) |\n" + rule + "---|\n";
  for (std::size_t r = 0; r < scene.results.size(); ++r) {
    out += "| `" + scene.results[r].name + "` |";
    for (const Column& cells : columns) {
      const std::string& text = cells.cells[r];
      out += text != "-" && text == cells.best ? " **" + text + "** |" : " " + text + " |";
    }
    out += " " + cost_text(scene, scene.results[r]) + " |\n";
  }
  return out + references_row(scene, groups);
}

std::string claims_markdown(const std::vector<Claim>& claims) {
  const auto listed = listed_claims(claims);
  std::string out;
  if (!listed.empty())
    out =
        "| claim | scene, component | ratio of `reliable` | bar | value | "
        "|\n|---|---|---|---|---|---|\n";
  for (const Claim& claim : listed)
    out += "| " + claim.effect + " | `" + claim.scene + "`, " + claim.layer + " | " +
           against_text(claim) + " | " + bar_text(claim) + " | " + number_text(claim.value, 4) +
           " | " + outcome_text(claim.outcome) + (claim.reference_limited ? "*" : "") + " |\n";
  const std::string others = everywhere_text(claims);
  return out + (out.empty() || others.empty() ? "" : "\n") + (others.empty() ? "" : others + "\n");
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

std::string quality_markdown(const std::vector<ReportScene>& scenes,
                             const std::vector<Claim>& claims) {
  std::string out = claims_markdown(claims);
  for (const ReportScene& scene : scenes) out += (out.empty() ? "" : "\n") + scene_markdown(scene);
  const bool limited =
      std::any_of(scenes.begin(), scenes.end(),
                  [](const ReportScene& scene) {
                    return references_row(scene, groups_of(scene)).find('*') != std::string::npos;
                  }) ||
      std::any_of(claims.begin(), claims.end(), [](const Claim& c) { return c.reference_limited; });
  return out + (limited ? "\n\\" + std::string(kLimitedNote) + "\n" : "");
}

void write_markdown(const std::filesystem::path& file, const std::string& text) {
  const std::string old = text_of(file);
  const std::string begin = std::string(kTableBegin) + "\n";
  const std::size_t from = old.find(begin), to = old.find(kTableEnd, from);
  const bool has_place = from != old.npos && to != old.npos;
  std::ofstream stream(file);
  stream << (has_place ? old.substr(0, from) + begin + text + old.substr(to) : text);
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace holdfast::measure
