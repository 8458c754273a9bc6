#pragma once

#include <cstddef>

namespace holdfast::wire {

/// What codecs read in place of a block of elements of 1, 2 or 4 bytes, since they find repeated
/// bytes but no gradients: each element minus the one `width` elements before it, the pixel above,
/// as unsigned words that wrap around; the first `width` elements as they are. Then the lowest
/// bytes of all of these, their next bytes, and so on. `bytes` is a multiple of `element`; `out`
/// has as many and does not overlap `in`.
void predict_bytes(const std::byte* in, std::size_t bytes, std::size_t element, std::size_t width,
                   std::byte* out);

/// The inverse.
void restore_bytes(const std::byte* in, std::size_t bytes, std::size_t element, std::size_t width,
                   std::byte* out);

}  // namespace holdfast::wire
