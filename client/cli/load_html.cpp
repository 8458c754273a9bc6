#include <algorithm>
#include <cstdio>

#include "client/cli/load.h"
#include "client/cli/load_plot.h"
#include "client/cli/percentiles.h"
#include "client/measure/report_plot.h"

namespace holdfast::cli {
namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --paper: #fbfbfc; --ink: #16202c; --quiet: #5d6b7a;
  --rule: #dde2e8; --p50: #2f9e77; --p95: #c9a227; --max: #c2453a; --bar: #2459c3; }
@media (prefers-color-scheme: dark) { :root { --paper: #11161d; --ink: #e6ebf1; --quiet: #93a1b1;
  --rule: #2b3542; --p50: #4fbd95; --p95: #dcb94b; --max: #f08076; --bar: #8fb4ff; } }
body { margin: 0 auto; max-width: 54rem; padding: 1.5rem 1rem 3rem; background: var(--paper);
  color: var(--ink); font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
.quiet { color: var(--quiet); margin: 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; text-align: right; border-bottom: 1px solid var(--rule); }
th { font-weight: 500; } thead th { color: var(--quiet); } tr > :first-child { text-align: left; }
svg { display: block; width: 100%; height: auto; } svg text { font-size: 12.5px; fill: var(--quiet); }
.grid { stroke: var(--rule); } .line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.p50 { stroke: var(--p50); } .p95 { stroke: var(--p95); } .max { stroke: var(--max); stroke-width: 1.2; }
.bar { fill: var(--bar); } .bad { color: var(--max); }
.key span { margin-right: 1.2rem; } .key span::before { content: ""; display: inline-block;
  width: 1rem; height: .2rem; margin-right: .4rem; vertical-align: middle; background: currentColor; }
.key .p50 { color: var(--p50); } .key .p95 { color: var(--p95); } .key .max { color: var(--max); }
)css";

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

std::string row(const char* cell, const std::vector<std::string>& cells) {
  std::string text = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string tag = i == 0 ? "th" : cell;
    text += "<" + tag + ">" + cells[i] + "</" + tag + ">";
  }
  return text + "</tr>";
}

std::string parts_table(const LoadTimes& times) {
  std::string rows;
  for (const LoadPart& part : kLoadParts) {
    const std::vector<double>& values = times.*part.values;
    std::vector<std::string> cells{part.name};
    for (const double fraction : {0.5, 0.95, 0.99, 1.0})
      cells.push_back(number(percentile(values, fraction), 2));
    rows += row("td", cells);
  }
  return "<table><thead>" + row("th", {"milliseconds", "p50", "p95", "p99", "max"}) +
         "</thead><tbody>" + rows + "</tbody></table>";
}

std::string errors_table(const LoadResult& result) {
  if (result.errors.empty()) return "<p class=\"quiet\">None.</p>";
  std::string rows;
  for (const auto& [kind, count] : result.errors)
    rows += row("td", {measure::escaped(kind), std::to_string(count)});
  return "<table class=\"bad\"><tbody>" + rows + "</tbody></table>";
}

/// The summary for a terminal up to its table, as paragraphs.
std::string summary(const LoadResult& result) {
  const std::string text = load_text(result);
  std::string html;
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos;
       at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line.starts_with("ms ")) break;
    html += "<p class=\"quiet\">" + measure::escaped(line) + "</p>";
  }
  return html;
}

}  // namespace

std::string load_html(const LoadResult& result) {
  const LoadTimes& times = result.times;
  return std::string(
             "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
             "<meta name=\"viewport\" content=\"width=device-width\">"
             "<title>Holdfast under load</title><style>") +
         kStyle + "</style></head><body><h1>Holdfast under load</h1>" + summary(result) +
         "<h2>Latency over time</h2><p class=\"key\"><span class=\"p50\">p50</span>"
         "<span class=\"p95\">p95</span><span class=\"max\">max</span> milliseconds</p>" +
         latency_over_time_svg(times.at_s, times.latency) + "<h2>Frames by latency</h2>" +
         latency_histogram_svg(times.latency) + "<h2>Where the time goes</h2>" +
         parts_table(times) + "<h2>Errors</h2>" + errors_table(result) + "</body></html>\n";
}

}  // namespace holdfast::cli
