#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/measure/claims.h"

namespace holdfast::measure {

/// Claims counted by outcome.
struct ClaimCount {
  int holds = 0, fails = 0, not_run = 0;
};
ClaimCount count_claims(const std::vector<Claim>& claims);

/// The claims that a table lists: those of single effects, and those of kEverywhere that fail.
std::vector<Claim> listed_claims(const std::vector<Claim>& claims);

/// How many of the claims of kEverywhere hold, as a sentence; empty without any.
std::string everywhere_text(const std::vector<Claim>& claims);

/// "RMSE over that of clamp": what the value of a claim is a ratio to.
std::string against_text(const Claim& claim);

/// "<= 0.84": the bar with its relation, ASCII.
std::string bar_text(const Claim& claim);

/// "holds", "fails" or "not run".
const char* outcome_text(Outcome outcome);

/// An array of {"effect":"shadows","scene":"fence","layer":"light0.visibility","mask":"effect",
/// "metric":"rmse","against":"clamp","value":0.36,"relation":"<=","bar":0.84,"pass":true,
/// "reference_limited":false}; value and pass are null for a claim that was not run.
nlohmann::ordered_json claims_json(const std::vector<Claim>& claims);

/// What an asterisk at a figure means.
inline constexpr const char* kLimitedNote =
    "* Two references differ by more than a tenth of the best RMSE here: their noise adds to every "
    "error, draws ratios towards 1, and hides small differences.";

/// A table of the listed claims with the sentence of the others, as part of a page.
std::string claims_html(const std::vector<Claim>& claims);

}  // namespace holdfast::measure
