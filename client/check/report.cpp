#include "client/check/report.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace holdfast::check {
namespace {

std::string formatted(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

}  // namespace

const char* verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk: return "ok";
    case Verdict::kWrong: return "wrong";
    case Verdict::kUnclear: return "unclear";
    case Verdict::kNoEvidence: return "no evidence";
  }
  return "";
}

std::string percent(double share) { return formatted("%.3g %%", share * 100); }
std::string number(double value) { return formatted("%.3g", value); }

std::string report_text(const Report& report) {
  std::string text;
  for (const Line& line : report.lines) {
    std::array<char, 64> head{};
    std::snprintf(head.data(), head.size(), "%-12s %-11s  ", line.check.c_str(),
                  verdict_text(line.verdict));
    text += head.data() + line.detail + '\n';
  }
  for (const Finding& finding : report.findings)
    text += "\n" + finding.thing + " " + finding.rule + "\n    " + finding.evidence + "\n    (" +
            finding.mistake + ")\n";
  text += "\n" + std::to_string(report.frames) + " frames: ";
  if (report.findings.empty()) return text + "nothing wrong was found\n";
  const std::size_t count = report.findings.size();
  return text + std::to_string(count) + (count == 1 ? " finding\n" : " findings\n");
}

nlohmann::ordered_json report_json(const Report& report) {
  nlohmann::ordered_json json{{"frames", report.frames},
                              {"checks", nlohmann::ordered_json::array()},
                              {"findings", nlohmann::ordered_json::array()}};
  for (const Line& line : report.lines)
    json["checks"].push_back(
        {{"check", line.check}, {"verdict", verdict_text(line.verdict)}, {"detail", line.detail}});
  for (const Finding& finding : report.findings)
    json["findings"].push_back({{"thing", finding.thing},
                                {"mistake", finding.mistake},
                                {"rule", finding.rule},
                                {"evidence", finding.evidence},
                                {"pixels", finding.pixels},
                                {"share", finding.share}});
  return json;
}

}  // namespace holdfast::check
