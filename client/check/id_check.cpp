#include <bit>
#include <cmath>
#include <map>

#include "client/check/parts.h"
#include "core/frame/conventions.h"

namespace holdfast::check {
namespace {

/// Pixels with a surface, by the id that they show.
using Shown = std::map<std::uint32_t, std::int64_t>;

Shown shown_ids(const Snapshots& frames) {
  Shown shown;
  for (const auto& [position, frame] : frames) {
    const Plane* plane = frame.find(PlaneKind::kObjectId);
    if (!plane) continue;
    const auto depth = frame.planes.at({PlaneKind::kDepth, {}}).channel(0);
    for (int y = 0; y < frame.height(); ++y)
      for (int x = 0; x < frame.width(); ++x)
        if (is_surface(depth.at(x, y))) ++shown[plane->ids().at(x, y)];
  }
  return shown;
}

/// True for the bits of a float that holds a whole number of at least 1.
bool is_float_bits(std::uint32_t id) {
  const float value = std::bit_cast<float>(id);
  return value >= 1 && value < 16777216 && std::floor(value) == value;
}

bool any_table_names(const std::vector<Tables>& all, std::uint32_t id) {
  for (const Tables& tables : all)
    if (tables.objects.contains(id)) return true;
  return false;
}

bool any_object(const std::vector<Tables>& all) {
  for (const Tables& tables : all)
    if (!tables.objects.empty()) return true;
  return false;
}

}  // namespace

void check_ids(const std::vector<Tables>& all, const Snapshots& frames, Report& report) {
  constexpr std::uint32_t kLargest = 0xFFFFFFFF;
  const Shown shown = shown_ids(frames);
  if (shown.empty()) return;
  std::int64_t pixels = 0, largest = 0, float_bits = 0;
  for (const auto& [id, count] : shown) {
    pixels += count;
    largest += id == kLargest ? count : 0;
    float_bits += id != 0 && is_float_bits(id) && !any_table_names(all, id) ? count : 0;
  }
  const auto find = [&](const char* mistake, std::int64_t bad, const std::string& what) {
    const double share = static_cast<double>(bad) / static_cast<double>(pixels);
    report.findings.push_back(
        {"objectId", mistake, "must be the 32-bit id of an instance, as the tables name it",
         percent(share) + " of " + std::to_string(pixels) + " pixels " + what, pixels, share});
  };
  const std::size_t first = report.findings.size();
  const std::uint32_t only = shown.begin()->first;
  if (largest * 100 > pixels)
    find("id-saturated", largest,
         "show 4294967295, which a real number becomes when a writer scales it to whole numbers");
  else if (float_bits * 2 > pixels)
    find("id-float-bits", float_bits, "show the bits of a float that holds a whole number");
  else if (shown.size() == 1 && any_object(all) && !any_table_names(all, only))
    find("id-unknown", pixels,
         "show " + std::to_string(only) + ", which no table names, and no other");
  if (report.findings.size() > first)
    report.add("ids", Verdict::kWrong, findings_since(report, first));
  else
    report.add("ids", Verdict::kOk, std::to_string(shown.size()) + " objects are seen");
}

}  // namespace holdfast::check
