#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace holdfast::wire {

/// What makes a block of bytes smaller without loss. The numbers are those of PlaneCodec in the
/// protocol.
enum class Codec : std::uint8_t {
  kNone = 0,
  kLz4 = 1,   ///< LZ4 block, no frame
  kZstd = 2,  ///< zstd frame, written at level 1
};

/// "none", "lz4", "zstd".
std::string_view codec_name(Codec codec);

/// The codec with that number in the protocol, if there is one.
std::optional<Codec> codec_from_number(int number);

/// Compresses and decompresses single blocks. Keeps its memory, so that nothing is allocated in the
/// steady state. One thread at a time.
class BlockCodec {
 public:
  BlockCodec();
  ~BlockCodec();
  BlockCodec(BlockCodec&&) noexcept;
  BlockCodec& operator=(BlockCodec&&) noexcept;

  /// Compresses `bytes` bytes to `out`, which has room for as many. The size of the result, or 0 if
  /// it would not be smaller (always without a codec).
  std::size_t compress(Codec codec, const std::byte* in, std::size_t bytes, std::byte* out);

  /// True if `in` is a block of `codec` that holds exactly `bytes` bytes, which are then in `out`;
  /// never writes beyond these, nor reads beyond `in`. False without a codec.
  bool decompress(Codec codec, std::string_view in, std::byte* out, std::size_t bytes);

  /// Memory that it may come to hold for blocks of 1 MiB, bytes: what zstd takes to compress at
  /// level 1, and to decompress.
  static constexpr std::size_t kCompressorBytes = 3u << 19;
  static constexpr std::size_t kDecompressorBytes = 1u << 18;

 private:
  struct Free {
    void operator()(ZSTD_CCtx_s* context) const;
    void operator()(ZSTD_DCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_CCtx_s, Free> compressor_;
  std::unique_ptr<ZSTD_DCtx_s, Free> decompressor_;
};

}  // namespace holdfast::wire
