#pragma once

#include <cstdint>
#include <string>

namespace holdfast::test {

/// What one session came to.
struct FuzzOutcome {
  std::string problem;  ///< what must not happen; empty if nothing did
  bool opened = false;  ///< the configuration was accepted
  int filtered = 0;     ///< frames
  int refused = 0;      ///< frames, by InputError
};

/// A session of a few small frames through the core's public door in which everything is random:
/// sizes, recipe, lights, planes, cameras, transforms, pixels, most of it extreme or wrong. All of
/// it follows from the seed. A problem is any exception but InputError, a result that is not
/// finite, a plane too many or too few, or a refused frame that left a trace in the results.
FuzzOutcome fuzz_session(std::uint32_t seed);

}  // namespace holdfast::test
