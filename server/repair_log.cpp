#include "server/repair_log.h"

namespace holdfast::server {

std::optional<std::string> RepairLog::note(const FrameReport& report, TimePoint now) {
  if (report.repaired.empty()) return std::nullopt;
  const std::lock_guard lock(mutex_);
  ++frames_;
  for (const RepairCount& repair : report.repaired) values_[repair.plane] += repair.values;
  if (said_ && now - *said_ < kInterval) return std::nullopt;
  said_ = now;
  std::string line = "frame=" + std::to_string(report.index) +
                     " frames_since_last=" + std::to_string(frames_) +
                     " lines_suppressed=" + std::to_string(frames_ - 1) + " values=\"";
  bool first = true;
  for (const auto& [plane, values] : values_) {
    line += (first ? "" : ", ") + plane_name(plane) + ": " + std::to_string(values);
    first = false;
  }
  frames_ = 0;
  values_.clear();
  return line + "\"";
}

}  // namespace holdfast::server
