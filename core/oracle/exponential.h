#pragma once

#include "core/history/accumulate.h"
#include "core/oracle/history.h"

namespace holdfast::oracle {

/// history/accumulate.h: an exponential mean along the effect's vector, else the surface's,
/// rectified as the rule says.
Blended blend_exponentially(const Surfaces& now, const Image& noisy, const Sources& sources,
                            const AccumulationRule& rule, const History& before, bool with_moments);

}  // namespace holdfast::oracle
