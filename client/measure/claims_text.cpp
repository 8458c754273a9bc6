#include "client/measure/claims_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "client/measure/report_plot.h"

namespace holdfast::measure {
namespace {

const char* relation_text(Relation relation) {
  return relation == Relation::kAtMost ? "<=" : relation == Relation::kBelow ? "<" : ">=";
}

std::string row_html(const Claim& claim) {
  const char* name = claim.outcome == Outcome::kHolds   ? "holds"
                     : claim.outcome == Outcome::kFails ? "fails"
                                                        : "open";
  const auto cell = [](const std::string& text) { return "<td>" + escaped(text) + "</td>"; };
  return "<tr><th>" + escaped(claim.effect) + "</th>" + cell(claim.scene + ", " + claim.layer) +
         cell(against_text(claim)) + cell(bar_text(claim)) + cell(number_text(claim.value, 4)) +
         "<td class=\"" + name + "\">" + outcome_text(claim.outcome) +
         (claim.reference_limited ? "*" : "") + "</td></tr>";
}

}  // namespace

ClaimCount count_claims(const std::vector<Claim>& claims) {
  ClaimCount count;
  for (const Claim& claim : claims)
    ++(claim.outcome == Outcome::kHolds   ? count.holds
       : claim.outcome == Outcome::kFails ? count.fails
                                          : count.not_run);
  return count;
}

std::vector<Claim> listed_claims(const std::vector<Claim>& claims) {
  std::vector<Claim> listed;
  std::copy_if(claims.begin(), claims.end(), std::back_inserter(listed), [](const Claim& claim) {
    return claim.effect != kEverywhere || claim.outcome == Outcome::kFails;
  });
  return listed;
}

std::string everywhere_text(const std::vector<Claim>& claims) {
  std::vector<Claim> general;
  std::copy_if(claims.begin(), claims.end(), std::back_inserter(general),
               [](const Claim& claim) { return claim.effect == kEverywhere; });
  if (general.empty()) return "";
  const ClaimCount count = count_claims(general);
  return "Never worse than spatial, clamp or paper, by RMSE or SSIM, with 0.5 % tolerance, for "
         "each "
         "scene, component and mask: " +
         std::to_string(count.holds) + " of " + std::to_string(count.holds + count.fails) +
         " comparisons hold" +
         (count.not_run > 0 ? ", " + std::to_string(count.not_run) + " were not run." : ".");
}

std::string against_text(const Claim& claim) {
  return std::string(claim.metric == Metric::kRmse ? "RMSE" : "SSIM") + " over that of " +
         (claim.against == kAllOthers ? "the best other recipe" : claim.against) +
         (claim.region == Region::kImage ? ", whole image" : "");
}

std::string bar_text(const Claim& claim) {
  return std::string(relation_text(claim.relation)) + " " +
         number_text(claim.bar, claim.effect == kEverywhere ? 3 : 2);
}

const char* outcome_text(Outcome outcome) {
  return outcome == Outcome::kHolds ? "holds" : outcome == Outcome::kFails ? "fails" : "not run";
}

nlohmann::ordered_json claims_json(const std::vector<Claim>& claims) {
  auto json = nlohmann::ordered_json::array();
  for (const Claim& claim : claims) {
    nlohmann::ordered_json row{{"effect", claim.effect},
                               {"scene", claim.scene},
                               {"layer", claim.layer},
                               {"mask", region_name(claim.region)},
                               {"metric", claim.metric == Metric::kRmse ? "rmse" : "ssim"},
                               {"against", claim.against},
                               {"value", nullptr},
                               {"relation", relation_text(claim.relation)},
                               {"bar", claim.bar},
                               {"pass", nullptr},
                               {"reference_limited", claim.reference_limited}};
    if (std::isfinite(claim.value)) row["value"] = claim.value;
    if (claim.outcome != Outcome::kNotRun) row["pass"] = claim.outcome == Outcome::kHolds;
    json.push_back(std::move(row));
  }
  return json;
}

std::string claims_html(const std::vector<Claim>& claims) {
  const std::vector<Claim> listed = listed_claims(claims);
  std::string html = "<div class=\"claims\"><p>" + escaped(everywhere_text(claims)) + "</p>";
  if (!listed.empty()) {
    html +=
        "<div class=\"wide\"><table><thead><tr><th>claim</th><th>scene, component</th>"
        "<th>ratio of reliable</th><th>bar</th><th>value</th><th>outcome</th></tr></thead><tbody>";
    for (const Claim& claim : listed) html += row_html(claim);
    html += "</tbody></table></div>";
  }
  const bool limited = std::any_of(claims.begin(), claims.end(),
                                   [](const Claim& claim) { return claim.reference_limited; });
  return html + (limited ? "<p class=\"note\">" + escaped(kLimitedNote) + "</p>" : "") + "</div>";
}

}  // namespace holdfast::measure
