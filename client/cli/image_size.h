#pragma once

#include <string>

namespace holdfast::cli {

/// Reads "480x270", pixels. Throws InputError with `subject` as the thing that is wrong.
void parse_image_size(const std::string& subject, const std::string& text, int& width, int& height);

}  // namespace holdfast::cli
