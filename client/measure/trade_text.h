#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/measure/trade.h"

namespace holdfast::measure {

/// What `holdfast study --trade --json` writes; docs/formats.md section 6 describes it.
nlohmann::ordered_json trade_json(const std::vector<TradeScene>& scenes);

/// A table over all scenes and one for each: named settings, and the front's others.
std::string trade_markdown(const std::vector<TradeScene>& scenes);

/// One page with the plot and the table of all scenes, then those of each. Throws
/// std::runtime_error if it cannot be written.
void write_trade_report(const std::filesystem::path& file, const std::vector<TradeScene>& scenes);

/// The plot over all scenes, or of the only one, as a file that stands alone. Throws
/// std::runtime_error if it cannot be written.
void write_trade_svg(const std::filesystem::path& file, const std::vector<TradeScene>& scenes);

}  // namespace holdfast::measure
