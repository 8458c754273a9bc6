#pragma once

#include <string>

#include "client/measure/report.h"

namespace holdfast::measure {

/// HTML table of one layer: a row for each result, errors over the image and over the effect, the
/// best value of each column in bold.
std::string table_html(const ReportScene& scene, std::size_t layer);

}  // namespace holdfast::measure
