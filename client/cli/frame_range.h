#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace holdfast::cli {

/// Indices of frames, both ends included.
struct FrameRange {
  std::int64_t first = std::numeric_limits<std::int64_t>::min();
  std::int64_t last = std::numeric_limits<std::int64_t>::max();

  bool contains(std::int64_t index) const { return index >= first && index <= last; }
};

/// A range from "A-B", or "A" for one frame; all frames for an empty text. Throws InputError for
/// anything else and for A > B.
FrameRange frame_range(const std::string& text);

}  // namespace holdfast::cli
