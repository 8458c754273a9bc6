#pragma once

#include "core/history/expected_error.h"
#include "core/history/radiance_blend.h"
#include "core/oracle/history.h"
#include "core/oracle/statistics.h"

namespace holdfast::oracle {

/// history/expected_error.h: a visibility blended with the candidate history of least expected
/// error. Differences are averaged within `footprint` (null: a square).
Blended blend_visibility(const Surfaces& now, const Image& noisy, const Sources& sources,
                         const Image& sample_variance, const Image* footprint,
                         const ExpectedErrorRule& rule, const History& before);

/// history/radiance_blend.h: the same for radiance. `at_rest`: nothing in the scene has moved.
Blended blend_radiance(const Surfaces& now, const Image& noisy, const Sources& sources,
                       const Image* footprint, const RadianceBlendRule& rule, bool at_rest,
                       const History& before);

}  // namespace holdfast::oracle
