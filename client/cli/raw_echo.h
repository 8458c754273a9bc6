#pragma once

#include <cstddef>

namespace holdfast::cli {

/// What moving bytes took.
struct TransportCost {
  double seconds = 0;      ///< wall
  double cpu_seconds = 0;  ///< of both ends
};

/// Moves `frames` frames of `up` bytes over a plain socket to a peer that answers each, once it has
/// all of it, with `down` bytes: pieces of 1 MiB, `in_flight` frames at most not yet answered, each
/// direction with a thread of its own on both sides, from and to memory of a frame's size. What a
/// stream of frames costs at least.
/// `tcp`: over the loopback address, else over a unix socket. Throws std::system_error.
TransportCost raw_echo(bool tcp, std::size_t up, std::size_t down, int frames, int in_flight);

/// CPU time of this process so far, seconds.
double own_cpu_seconds();

}  // namespace holdfast::cli
