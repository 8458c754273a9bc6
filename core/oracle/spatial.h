#pragma once

#include "core/oracle/history.h"
#include "core/oracle/statistics.h"
#include "core/spatial/adaptive_filter.h"

namespace holdfast::oracle {

/// spatial/adaptive_filter.h: a-trous levels whose taps count by the samples behind them, stopped
/// by a prefiltered luminance and the effect's footprint.
Image filter_by_samples(const Surfaces& now, const History& history, const Statistics& statistics,
                        const AdaptiveFilterSettings& settings);

/// spatial/svgf_filter.h: a-trous levels guided by variance. The first level replaces
/// `history.signal`.
Image filter_by_variance(const Surfaces& now, const Statistics& statistics, int levels,
                         History& history);

}  // namespace holdfast::oracle
