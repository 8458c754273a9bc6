#pragma once

#include <string_view>

namespace holdfast::measure {

// The files report.css, report.html and report.js, built into the program.
extern const std::string_view kReportStyle, kReportIntroduction, kReportScript;

}  // namespace holdfast::measure
