#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace holdfast::check {

/// One input that is wrong.
struct Finding {
  std::string thing;        ///< what is wrong: "camera.viewFromWorld", "motion.X/Y"
  std::string mistake;      ///< which of the known mistakes, for machines: "view-inverse"
  std::string rule;         ///< what must hold
  std::string evidence;     ///< what was seen, with figures
  std::int64_t pixels = 0;  ///< samples looked at
  double share = 0;         ///< 0..1: those that speak for the finding
};

enum class Verdict {
  kOk,         ///< looked at, and nothing wrong was seen
  kWrong,      ///< there is a finding
  kUnclear,    ///< does not fit, and no known mistake explains it
  kNoEvidence  ///< the sequence cannot show a mistake here
};

/// "ok", "wrong", "unclear" or "no evidence".
const char* verdict_text(Verdict verdict);

/// What was looked at, and what came of it.
struct Line {
  std::string check;  ///< "camera", "motion", "light0"
  Verdict verdict = Verdict::kNoEvidence;
  std::string detail;
};

/// The outcome of a check.
struct Report {
  std::int64_t frames = 0;
  std::vector<Line> lines;
  std::vector<Finding> findings;

  void add(std::string check, Verdict verdict, std::string detail) {
    lines.push_back({std::move(check), verdict, std::move(detail)});
  }
};

/// The form for people: one line a check, then the findings with rule and evidence.
std::string report_text(const Report& report);

/// The form for machines; documented in docs/formats.md.
nlohmann::ordered_json report_json(const Report& report);

/// "97.3 %" of a share in 0..1.
std::string percent(double share);
/// Three significant digits.
std::string number(double value);

}  // namespace holdfast::check
