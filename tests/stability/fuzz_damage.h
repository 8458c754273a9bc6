#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/core/small_world.h"

namespace holdfast::test {

/// What readers made of the inputs of one case.
struct ReadOutcome {
  std::string problem;  ///< what must not happen; empty if nothing did
  int accepted = 0;     ///< inputs
  int refused = 0;      ///< inputs, by an error that names what is wrong
};

/// True in that share of the cases.
inline bool chance(Random& random, double share) { return random.uniform() < share; }

/// A number in 0..count-1; `count` >= 1.
std::size_t below(Random& random, std::size_t count);

/// Bytes that were flipped, replaced, cut out, cut off, doubled or moved, or that a few of `words`
/// or a number of extreme value took the place of: one to a few of these, near each other or not.
std::string damaged(std::string bytes, Random& random,
                    std::span<const std::string_view> words = {});

/// The text as tokens of JSON: strings, other words and single characters; spaces are left out.
std::vector<std::string> json_tokens(std::string_view text);

/// JSON of which a few tokens were replaced by others (of another type, too large, too deep, no
/// JSON at all), left out, doubled or exchanged, or copied to another place with what they enclose.
std::string damaged_json(std::string_view text, Random& random);

}  // namespace holdfast::test
