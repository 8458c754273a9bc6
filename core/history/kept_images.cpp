#include "core/history/kept_images.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/history/byte_block.h"
#include "core/history/half_block.h"
#include "core/kernels/parallel.h"
#include "core/kernels/random.h"

namespace holdfast {
namespace {

static_assert(kHalfBlock == kByteBlock);

int count_of(const std::vector<KeptAs>& channels, bool halves) {
  return static_cast<int>(std::count_if(channels.begin(), channels.end(), [&](KeptAs as) {
    return (as == KeptAs::kHalf) == halves;
  }));
}

ByteKind byte_kind(KeptAs as) {
  return as == KeptAs::kFineByte ? ByteKind::kFine : ByteKind::kPlain;
}

/// Calls `body(c, as, k)` for every channel c, which is the k-th of its kind.
template <class Body>
void for_each_channel(const std::vector<KeptAs>& channels, const Body& body) {
  int of_kind[2] = {0, 0};
  for (std::size_t c = 0; c < channels.size(); ++c)
    body(static_cast<int>(c), channels[c], of_kind[channels[c] == KeptAs::kHalf ? 1 : 0]++);
}

}  // namespace

KeptImages::KeptImages(int width, int height, std::vector<KeptAs> channels, HistoryFormat format)
    : format_(format), width_(width), height_(height), channels_(std::move(channels)) {
  static_assert(kBlock == kHalfBlock);
  const int count = static_cast<int>(channels_.size());
  if (format == HistoryFormat::kFloat) whole_ = Channels<float>(width, height, count);
  if (format != HistoryFormat::kPacked) return;
  if (const int halves = count_of(channels_, true))
    halves_ = Channels<std::uint16_t>(width, height, halves);
  if (const int bytes = count_of(channels_, false))
    bytes_ = Channels<std::uint8_t>(width, height, bytes);
  exponents_ = Channels<std::int8_t>(blocks() * count, height, 1);
}

void KeptImages::recall(Channels<float>& room, const RowStep& unpacked) {
  if (format_ == HistoryFormat::kPacked) {
    assert(room.count() == static_cast<int>(channels_.size()) && room.width() == width_);
    for_each_row(height_, [&](int y) {
      unpack_row(y, room);
      if (unpacked) unpacked(room, y);
    });
  }
  if (format_ == HistoryFormat::kFloat) std::swap(whole_, room);
}

void KeptImages::keep(Channels<float>& now, std::uint64_t key, const RowStep& packing) {
  if (format_ == HistoryFormat::kPacked) {
    assert(now.count() == static_cast<int>(channels_.size()) && now.width() == width_);
    for_each_row(height_, [&](int y) {
      if (packing) packing(now, y);
      pack_row(y, now, key);
    });
  }
  if (format_ == HistoryFormat::kFloat) std::swap(whole_, now);
}

Channels<float> KeptImages::copy() const {
  Channels<float> out(width_, height_, static_cast<int>(channels_.size()));
  for_each_row(height_, [&](int y) {
    if (format_ == HistoryFormat::kPacked) unpack_row(y, out);
    if (format_ == HistoryFormat::kFloat)
      for (int c = 0; c < out.count(); ++c) std::copy_n(whole_[c].row(y), width_, out[c].row(y));
  });
  return out;
}

void KeptImages::unpack_row(int y, Channels<float>& room) const {
  for (int x = 0; x < width_; x += kBlock) {
    const int count = std::min(kBlock, width_ - x);
    const std::int8_t* exponents = exponents_[0].row(y) + x / kBlock;
    for_each_channel(channels_, [&](int c, KeptAs as, int k) {
      const std::int8_t exponent = exponents[c * blocks()];
      float* out = room[c].row(y) + x;
      if (as == KeptAs::kHalf)
        unpack_half_block({halves_[k].row(y) + x, count, exponent, out});
      else
        unpack_byte_block({bytes_[k].row(y) + x, count, byte_kind(as), exponent, out});
    });
  }
}

void KeptImages::pack_row(int y, const Channels<float>& now, std::uint64_t key) {
  std::uint32_t random[kBlock];
  for (int x = 0; x < width_; x += kBlock) {
    const int count = std::min(kBlock, width_ - x);
    const std::uint64_t block =
        (static_cast<std::uint64_t>(y) << 32) + static_cast<std::uint64_t>(x);
    draw_block_bits({static_cast<std::uint32_t>(mix_bits(key + block)), random});
    std::int8_t* exponents = exponents_[0].row(y) + x / kBlock;
    for_each_channel(channels_, [&](int c, KeptAs as, int k) {
      std::int8_t* exponent = exponents + c * blocks();
      const float* in = now[c].row(y) + x;
      if (as == KeptAs::kHalf)
        pack_half_block({in, count, random, halves_[k].row(y) + x, exponent});
      else
        pack_byte_block({in, count, byte_kind(as), random, bytes_[k].row(y) + x, exponent});
    });
  }
}

}  // namespace holdfast
