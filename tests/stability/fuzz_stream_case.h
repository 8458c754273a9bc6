#pragma once

#include "tests/stability/fuzz_damage.h"

namespace holdfast::test {

// What a server makes of bytes from the network, without a network. All of each case follows from
// its seed.

/// Messages with a chunk, damaged and in pieces. A problem is one that our reader and the generated
/// class both read and read differently, that ours alone reads, or that ours does not read although
/// it is written in the usual way.
ReadOutcome fuzz_chunk_message(std::uint32_t seed);

/// Blocks of planes of any kind, format and codec, damaged or of nothing but noise, in pieces. A
/// problem is any exception, a write outside the piece, a block refused after a part of it was
/// written, and an undamaged block that is refused afterwards or comes back otherwise.
ReadOutcome fuzz_block(std::uint32_t seed);

/// Frames as messages that are left out, doubled, exchanged, cut off, or wrong in a field or a
/// byte, handled by the rules of a stream; half of the streams have shared memory, where sizes,
/// cells and bytes are wrong as well. A problem is an error that names no rule, more memory
/// than 2 MiB and 8 times the messages, and an undamaged frame that is not accepted afterwards with
/// the right bits.
ReadOutcome fuzz_frames(std::uint32_t seed);

/// One of these.
ReadOutcome fuzz_stream(std::uint32_t seed);

}  // namespace holdfast::test
