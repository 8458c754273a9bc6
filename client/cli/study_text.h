#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/cli/study.h"
#include "client/measure/claims.h"

namespace holdfast::cli {

/// What `holdfast study --quality --json` writes; docs/formats.md section 6 describes it.
nlohmann::ordered_json quality_json(const StudyResult& study,
                                    const std::vector<measure::Claim>& claims);

}  // namespace holdfast::cli
