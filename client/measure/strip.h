#pragma once

#include <string>
#include <vector>

#include "client/measure/picture.h"
#include "client/measure/report.h"

namespace holdfast::measure {

/// The part of a scene's composite where most changes, enlarged and labelled, side by side: the
/// noisy frame, the results called `names` (those that there are), the reference. Shows the last
/// judged frame. At most 1600 pixels wide for up to four pictures. Throws InputError for input
/// that cannot be read or has no composite.
Picture strip_of(const ReportScene& scene, const std::vector<std::string>& names);

}  // namespace holdfast::measure
