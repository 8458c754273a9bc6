#pragma once

#include <string_view>

#include "client/measure/picture.h"

namespace holdfast::measure {

inline constexpr int kGlyphWidth = 5;   ///< pixels at scale 1, with one more between letters
inline constexpr int kGlyphHeight = 8;  ///< pixels at scale 1; letters stand on the seventh row

/// Pixels across that `text` takes at `scale`.
int text_width(std::string_view text, int scale);

/// Writes `text` in white, with its top left corner at (x, y), each pixel of a letter `scale`
/// pixels large. Knows small letters, digits and . , - %; anything else is a space. What lies
/// outside is left out.
void draw_text(Picture& picture, int x, int y, std::string_view text, int scale);

}  // namespace holdfast::measure
