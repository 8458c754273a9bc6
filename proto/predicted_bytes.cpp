#include "proto/predicted_bytes.h"

#include <cstdint>

#include "core/kernels/variants.h"

namespace holdfast::wire {
namespace {

struct Block {
  const std::byte* in;
  std::size_t count, width;  ///< elements
  std::byte* out;
};

template <class T>
HOLDFAST_INLINE T element_at(const std::byte* bytes, std::size_t i) {
  T value;
  __builtin_memcpy(&value, bytes + i * sizeof(T), sizeof(T));
  return value;
}

template <class T>
HOLDFAST_INLINE T joined(const std::byte* in, std::size_t i, std::size_t count) {
  std::uint32_t word = static_cast<std::uint8_t>(in[i]);
  if constexpr (sizeof(T) >= 2)
    word |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(in[count + i])) << 8;
  if constexpr (sizeof(T) == 4) {
    word |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(in[2 * count + i])) << 16;
    word |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(in[3 * count + i])) << 24;
  }
  return static_cast<T>(word);
}

/// A pass for each byte of an element: a loop with four places to write to does not vectorise.
template <class T>
HOLDFAST_INLINE void predict_block(const Block& a) {
  const std::byte* __restrict in = a.in;
  std::byte* __restrict out = a.out;
  const std::size_t count = a.count, width = a.width, first = min_of(a.width, a.count);
  for (unsigned shift = 0; shift < 8 * sizeof(T); shift += 8, out += count) {
    for (std::size_t i = 0; i < first; ++i)
      out[i] = static_cast<std::byte>(element_at<T>(in, i) >> shift);
    for (std::size_t i = first; i < count; ++i) {
      const T difference = static_cast<T>(element_at<T>(in, i) - element_at<T>(in, i - width));
      out[i] = static_cast<std::byte>(difference >> shift);
    }
  }
}

/// One row, from the row above: the two do not overlap, so that the loop vectorises.
template <class T>
HOLDFAST_INLINE void restore_row(const std::byte* __restrict in, std::size_t start, std::size_t end,
                                 std::size_t count, const std::byte* __restrict above,
                                 std::byte* __restrict out) {
  for (std::size_t i = start; i < end; ++i) {
    const T value = static_cast<T>(joined<T>(in, i, count) + element_at<T>(above, i - start));
    __builtin_memcpy(out + (i - start) * sizeof(T), &value, sizeof(T));
  }
}

template <class T>
HOLDFAST_INLINE void restore_block(const Block& a) {
  const std::size_t count = a.count, width = a.width, first = min_of(a.width, a.count);
  for (std::size_t i = 0; i < first; ++i) {
    const T value = joined<T>(a.in, i, count);
    __builtin_memcpy(a.out + i * sizeof(T), &value, sizeof(T));
  }
  for (std::size_t start = first; start < count; start += width) {
    std::byte* const row = a.out + start * sizeof(T);
    restore_row<T>(a.in, start, min_of(start + width, count), count, row - width * sizeof(T), row);
  }
}

HOLDFAST_INLINE void predict1_body(const Block& a) { predict_block<std::uint8_t>(a); }
HOLDFAST_INLINE void predict2_body(const Block& a) { predict_block<std::uint16_t>(a); }
HOLDFAST_INLINE void predict4_body(const Block& a) { predict_block<std::uint32_t>(a); }
HOLDFAST_INLINE void restore1_body(const Block& a) { restore_block<std::uint8_t>(a); }
HOLDFAST_INLINE void restore2_body(const Block& a) { restore_block<std::uint16_t>(a); }
HOLDFAST_INLINE void restore4_body(const Block& a) { restore_block<std::uint32_t>(a); }

HOLDFAST_KERNEL(predict1, Block)
HOLDFAST_KERNEL(predict2, Block)
HOLDFAST_KERNEL(predict4, Block)
HOLDFAST_KERNEL(restore1, Block)
HOLDFAST_KERNEL(restore2, Block)
HOLDFAST_KERNEL(restore4, Block)

}  // namespace

void predict_bytes(const std::byte* in, std::size_t bytes, std::size_t element, std::size_t width,
                   std::byte* out) {
  const Block block{in, bytes / element, width, out};
  if (element == 1) predict1(block);
  if (element == 2) predict2(block);
  if (element == 4) predict4(block);
}

void restore_bytes(const std::byte* in, std::size_t bytes, std::size_t element, std::size_t width,
                   std::byte* out) {
  const Block block{in, bytes / element, width, out};
  if (element == 1) restore1(block);
  if (element == 2) restore2(block);
  if (element == 4) restore4(block);
}

}  // namespace holdfast::wire
