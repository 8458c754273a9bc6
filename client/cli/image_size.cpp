#include "client/cli/image_size.h"

#include <charconv>

#include "core/frame/error.h"

namespace holdfast::cli {

void parse_image_size(const std::string& subject, const std::string& text, int& width,
                      int& height) {
  const char* const end = text.data() + text.size();
  const auto w = std::from_chars(text.data(), end, width);
  const bool has_width = w.ec == std::errc{} && w.ptr != end && *w.ptr == 'x';
  const auto h = has_width ? std::from_chars(w.ptr + 1, end, height) : w;
  if (!has_width || h.ec != std::errc{} || h.ptr != end)
    throw InputError(subject, "must be WIDTHxHEIGHT in pixels", text);
}

}  // namespace holdfast::cli
