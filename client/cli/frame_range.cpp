#include "client/cli/frame_range.h"

#include <charconv>

#include "core/frame/error.h"

namespace holdfast::cli {

FrameRange frame_range(const std::string& text) {
  FrameRange range;
  if (text.empty()) return range;
  const char* const end = text.data() + text.size();
  auto [next, error] = std::from_chars(text.data(), end, range.first);
  range.last = range.first;
  bool good = error == std::errc();
  if (good && next != end) {
    good = *next == '-';
    const auto second = std::from_chars(next + (good ? 1 : 0), end, range.last);
    good = good && second.ec == std::errc() && second.ptr == end;
  }
  if (!good || range.first > range.last)
    throw InputError("--frames", "must be A-B with A <= B, or one index", "\"" + text + "\"");
  return range;
}

}  // namespace holdfast::cli
