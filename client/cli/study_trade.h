#pragma once

#include <filesystem>
#include <vector>

#include "client/cli/study.h"
#include "client/measure/trade.h"

namespace holdfast::cli {

/// Renders, or keeps, each scene's sequence as `run_study` does, and tries the settings of
/// `trade_settings` on it: frame by frame, all settings in turn, so that what else the machine does
/// meets all of them, on one thread. The first two frames are not timed. Errors are those of the
/// composite over the frames with references. Settings with the same plan are measured once. Steps
/// and their seconds are added to `steps`. Throws InputError for an unknown recipe or scene, or a
/// sequence without references within `frames`.
std::vector<measure::TradeScene> study_trade(const StudyOptions& options, std::int64_t frames,
                                             std::vector<StudyStep>& steps);

}  // namespace holdfast::cli
