#include "proto/codec.h"

#include <lz4.h>
#include <zstd.h>

#include <array>
#include <new>

namespace holdfast::wire {
namespace {

constexpr std::array<std::string_view, 3> kNames{"none", "lz4", "zstd"};
constexpr int kZstdLevel = 1;

/// `pointer` as what the libraries call bytes.
const char* chars(const std::byte* pointer) { return reinterpret_cast<const char*>(pointer); }
char* chars(std::byte* pointer) { return reinterpret_cast<char*>(pointer); }

template <class Pointer>
void require_memory(const Pointer& pointer) {
  if (!pointer) throw std::bad_alloc();
}

}  // namespace

std::string_view codec_name(Codec codec) { return kNames[static_cast<std::size_t>(codec)]; }

std::optional<Codec> codec_from_number(int number) {
  if (number < 0 || number >= static_cast<int>(kNames.size())) return std::nullopt;
  return static_cast<Codec>(number);
}

void BlockCodec::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void BlockCodec::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

BlockCodec::BlockCodec() = default;
BlockCodec::~BlockCodec() = default;
BlockCodec::BlockCodec(BlockCodec&&) noexcept = default;
BlockCodec& BlockCodec::operator=(BlockCodec&&) noexcept = default;

std::size_t BlockCodec::compress(Codec codec, const std::byte* in, std::size_t bytes,
                                 std::byte* out) {
  if (codec == Codec::kNone || bytes < 2) return 0;
  const std::size_t room = bytes - 1;
  if (codec == Codec::kLz4) {
    const int size = LZ4_compress_default(chars(in), chars(out), static_cast<int>(bytes),
                                          static_cast<int>(room));
    return static_cast<std::size_t>(size);
  }
  if (!compressor_) compressor_.reset(ZSTD_createCCtx());
  require_memory(compressor_);
  const std::size_t size = ZSTD_compressCCtx(compressor_.get(), out, room, in, bytes, kZstdLevel);
  return ZSTD_isError(size) != 0 ? 0 : size;
}

bool BlockCodec::decompress(Codec codec, std::string_view in, std::byte* out, std::size_t bytes) {
  if (codec == Codec::kNone) return false;
  if (codec == Codec::kLz4) {
    const int size = LZ4_decompress_safe(in.data(), chars(out), static_cast<int>(in.size()),
                                         static_cast<int>(bytes));
    return size >= 0 && static_cast<std::size_t>(size) == bytes;
  }
  if (!decompressor_) decompressor_.reset(ZSTD_createDCtx());
  require_memory(decompressor_);
  const std::size_t size =
      ZSTD_decompressDCtx(decompressor_.get(), out, bytes, in.data(), in.size());
  return size == bytes;
}

}  // namespace holdfast::wire
