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

/// Calls `body(c, as, k, x, count)` for every block of a row: channel c is the k-th of its kind.
template <class Body>
void for_each_block(const std::vector<KeptAs>& channels, int width, const Body& body) {
  int of_kind[2] = {0, 0};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const int k = of_kind[channels[c] == KeptAs::kHalf ? 1 : 0]++;
    for (int x = 0; x < width; x += kHalfBlock)
      body(static_cast<int>(c), channels[c], k, x, std::min(kHalfBlock, width - x));
  }
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

void KeptImages::recall(Channels<float>& room) {
  if (format_ == HistoryFormat::kPacked) unpack(room);
  if (format_ == HistoryFormat::kFloat) std::swap(whole_, room);
}

void KeptImages::keep(Channels<float>& now, std::uint64_t key) {
  if (format_ == HistoryFormat::kPacked) pack(now, key);
  if (format_ == HistoryFormat::kFloat) std::swap(whole_, now);
}

Channels<float> KeptImages::copy() const {
  Channels<float> out(width_, height_, static_cast<int>(channels_.size()));
  if (format_ == HistoryFormat::kPacked) unpack(out);
  if (format_ == HistoryFormat::kFloat)
    for_each_row(height_, [&](int y) {
      for (int c = 0; c < out.count(); ++c) std::copy_n(whole_[c].row(y), width_, out[c].row(y));
    });
  return out;
}

void KeptImages::unpack(Channels<float>& room) const {
  assert(room.count() == static_cast<int>(channels_.size()) && room.width() == width_);
  for_each_row(height_, [&](int y) {
    const std::int8_t* exponents = exponents_[0].row(y);
    for_each_block(channels_, width_, [&](int c, KeptAs as, int k, int x, int count) {
      const std::int8_t exponent = exponents[c * blocks() + x / kBlock];
      float* out = room[c].row(y) + x;
      if (as == KeptAs::kHalf)
        unpack_half_block({halves_[k].row(y) + x, count, exponent, out});
      else
        unpack_byte_block({bytes_[k].row(y) + x, count, as == KeptAs::kSignedByte, exponent, out});
    });
  });
}

void KeptImages::pack(const Channels<float>& now, std::uint64_t key) {
  assert(now.count() == static_cast<int>(channels_.size()) && now.width() == width_);
  for_each_row(height_, [&](int y) {
    std::int8_t* exponents = exponents_[0].row(y);
    for_each_block(channels_, width_, [&](int c, KeptAs as, int k, int x, int count) {
      const int block = c * blocks() + x / kBlock;
      const auto seed = static_cast<std::uint32_t>(
          mix_bits(key + (static_cast<std::uint64_t>(y) << 32) + static_cast<std::uint64_t>(block)));
      const float* in = now[c].row(y) + x;
      if (as == KeptAs::kHalf)
        pack_half_block({in, count, seed, halves_[k].row(y) + x, exponents + block});
      else
        pack_byte_block({in, count, as == KeptAs::kSignedByte, seed, bytes_[k].row(y) + x,
                         exponents + block});
    });
  });
}

}  // namespace holdfast
