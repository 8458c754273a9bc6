// Chunks as messages and as blocks.
#include <array>
#include <cstring>
#include <exception>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/chunk_message.h"
#include "proto/plane_coder.h"
#include "tests/stability/fuzz_message.h"
#include "tests/stability/fuzz_stream_case.h"

namespace holdfast::test {
namespace {

std::string joined(const std::vector<std::string_view>& pieces) {
  std::string out;
  for (const std::string_view piece : pieces) out += piece;
  return out;
}

std::uint64_t any_number(Random& random) {
  const std::uint64_t bits = std::uint64_t{random.bits()} << 32 | random.bits();
  return bits >> below(random, 64);
}

/// Numbers that need all bytes of a varint and more, and what may stand in front of them.
constexpr std::string_view kWireWords[] = {"\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01",
                                           "\xff\xff\xff\xff\xff\xff\xff\xff\xff\x7f",
                                           "\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80",
                                           "\xff\xff\xff\xff\x0f",
                                           "\x08",
                                           "\x10",
                                           "\x18",
                                           "\x22",
                                           "\x28",
                                           "\x1a",
                                           "\x0a",
                                           "\x12",
                                           "\x22\xff\xff\xff\xff\x07",
                                           "\x2b",
                                           "\x2c",
                                           "\x25"};

v1::DenoiseRequest any_chunk(Random& random) {
  v1::DenoiseRequest request;
  v1::PlaneChunk& chunk = *request.mutable_plane_chunk();
  if (chance(random, 0.7)) chunk.set_plane(static_cast<std::uint32_t>(any_number(random)));
  if (chance(random, 0.7)) chunk.set_offset(any_number(random));
  chunk.set_last(chance(random, 0.5));
  if (chance(random, 0.8)) chunk.set_data(std::string(below(random, 300), 'x'));
  if (chance(random, 0.5)) chunk.set_plain_bytes(static_cast<std::uint32_t>(any_number(random)));
  return request;
}

constexpr std::uint32_t kUntouched = 0x7fc12345;  // a NaN that no format decodes to

/// A plane, how it is written, and a piece of it in elements.
struct Piece {
  wire::PlaneCoding coding;
  Plane plane;
  std::size_t first = 0, count = 0;

  std::size_t offset() const { return first * wire::element_bytes(coding.format); }
  std::size_t bytes() const { return count * wire::element_bytes(coding.format); }
};

Piece any_piece(Random& random) {
  Piece piece;
  const auto kind = static_cast<PlaneKind>(below(random, kPlaneKindCount));
  do piece.coding.format = static_cast<wire::PlaneFormat>(1 + below(random, 9));
  while (!wire::format_suits(piece.coding.format, kind));
  piece.coding.codec = static_cast<wire::Codec>(below(random, 3));
  piece.plane = Plane({kind, {}}, 1 + static_cast<int>(below(random, 70)),
                      1 + static_cast<int>(below(random, 12)));
  for (int c = 0; c < piece.plane.channels(); ++c)
    for (int y = 0; y < piece.plane.height(); ++y)
      for (int x = 0; x < piece.plane.width(); ++x)
        piece.plane.words(c).at(x, y) = static_cast<std::uint32_t>(x / 5) << (random.bits() & 16);
  const std::size_t elements = wire::plane_bytes(piece.plane, piece.coding.format) /
                               wire::element_bytes(piece.coding.format);
  piece.first = chance(random, 0.5) ? 0 : below(random, elements);
  piece.count = elements - piece.first;
  return piece;
}

Plane untouched(const Plane& like) {
  Plane plane(like.id(), like.width(), like.height());
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) plane.words(c).at(x, y) = kUntouched;
  return plane;
}

/// How many words were written outside the piece, and inside.
struct Written {
  std::size_t outside = 0, inside = 0;
};

Written written(const Plane& plane, const Piece& piece) {
  Written out;
  const bool pixels = wire::joins_channels(piece.coding.format);
  std::size_t element = 0;
  for (int c = 0; c < plane.channels(); ++c) {
    if (pixels) element = 0;
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x, ++element) {
        if (plane.words(c).at(x, y) == kUntouched) continue;
        const bool in = element >= piece.first && element < piece.first + piece.count;
        ++(in ? out.inside : out.outside);
      }
  }
  return out;
}

/// Decodes `data` in pieces that each have a block of memory of their own, so that nothing can be
/// read beyond one unseen.
bool decode(wire::PlaneCoder& coder, Plane& plane, const Piece& piece, const std::string& data,
            Random& random) {
  std::vector<std::unique_ptr<char[]>> blocks;
  std::vector<std::string_view> views;
  for (std::size_t at = 0; at < data.size();) {
    const std::size_t size = 1 + below(random, chance(random, 0.5) ? data.size() - at : 5);
    const std::size_t taken = std::min(size, data.size() - at);
    blocks.push_back(std::make_unique<char[]>(taken));
    std::memcpy(blocks.back().get(), data.data() + at, taken);
    views.emplace_back(blocks.back().get(), taken);
    at += taken;
  }
  return coder.decode(plane, piece.coding, piece.offset(), piece.bytes(), views);
}

std::string fuzz_blocks(Random& random, ReadOutcome& outcome) {
  const Piece piece = any_piece(random);
  wire::PlaneCoder coder;
  std::string good;
  if (coder.encode(piece.plane, piece.coding, piece.offset(), good) != piece.bytes())
    return "a block of another size was made";
  for (int i = 0; i < 4; ++i) {
    std::string data = chance(random, 0.8) ? damaged(good, random) : std::string();
    if (data.empty() && chance(random, 0.7))
      for (std::size_t n = below(random, piece.bytes() + 1); n > 0; --n)
        data += static_cast<char>(random.bits());
    Plane plane = untouched(piece.plane);
    const bool accepted = decode(coder, plane, piece, data, random);
    ++(accepted ? outcome.accepted : outcome.refused);
    const auto [outside, inside] = written(plane, piece);
    if (outside > 0) return "values outside the piece were written";
    if (!accepted && inside > 0) return "a block was refused after a part of it was written";
  }
  Plane first = untouched(piece.plane), second = untouched(piece.plane);
  if (!decode(coder, first, piece, good, random) ||
      !wire::PlaneCoder().decode(second, piece.coding, piece.offset(), piece.bytes(), good))
    return "an undamaged block is refused";
  for (int c = 0; c < first.channels(); ++c)
    for (int y = 0; y < first.height(); ++y)
      for (int x = 0; x < first.width(); ++x)
        if (first.words(c).at(x, y) != second.words(c).at(x, y))
          return "a block comes back otherwise";
  return {};
}

}  // namespace

ReadOutcome fuzz_chunk_message(std::uint32_t seed) {
  ReadOutcome outcome;
  Random random(seed);
  wire::ChunkReader reader;
  for (int i = 0; i < 16 && outcome.problem.empty(); ++i) {
    const std::string good = any_chunk(random).SerializeAsString();
    const std::string bytes = chance(random, 0.1) ? good : damaged(good, random, kWireWords);
    const wire::ChunkView* const ours = reader.read(in_pieces(bytes, random));
    v1::DenoiseRequest request;
    grpc::ByteBuffer buffer = in_pieces(bytes, random);
    const bool parsed = wire::parse_message(buffer, request);
    const bool theirs = parsed && request.has_plane_chunk();
    ++(theirs ? outcome.accepted : outcome.refused);
    request.DiscardUnknownFields();
    const bool usual = theirs && request.SerializeAsString() == bytes;
    if (ours == nullptr && usual) outcome.problem = "a usual message is not read";
    if (ours == nullptr) continue;
    if (!theirs) {
      outcome.problem = "the generated class does not read it";
    } else {
      const wire::ChunkView view = wire::view_of(request.plane_chunk());
      if (ours->fields != view.fields || ours->data_bytes != view.data_bytes ||
          joined(ours->data) != joined(view.data))
        outcome.problem = "the generated class reads another chunk";
    }
  }
  return outcome;
}

ReadOutcome fuzz_block(std::uint32_t seed) {
  ReadOutcome outcome;
  Random random(seed);
  try {
    outcome.problem = fuzz_blocks(random, outcome);
  } catch (const std::exception& error) {
    outcome.problem = std::string("it threw: ") + error.what();
  }
  return outcome;
}

ReadOutcome fuzz_stream(std::uint32_t seed) {
  constexpr ReadOutcome (*kCases[])(std::uint32_t) = {fuzz_chunk_message, fuzz_block, fuzz_frames};
  constexpr const char* kNames[] = {"chunk message: ", "block: ", "frames: "};
  ReadOutcome outcome = kCases[seed % 3](seed);
  if (!outcome.problem.empty()) outcome.problem = kNames[seed % 3] + outcome.problem;
  return outcome;
}

}  // namespace holdfast::test
