#pragma once

#include <filesystem>

#include "tests/stability/fuzz_damage.h"

namespace holdfast::test {

/// A sequence.json, a scene or an OBJ mesh, damaged by token or by byte, written to a file in
/// `folder` and read. All of it follows from the seed. A problem is any exception but an InputError
/// that names the file in a message of bounded length, more memory than 1 MiB and 300 times the
/// file, or an accepted file with a number or an index that is out of range.
ReadOutcome fuzz_json(std::uint32_t seed, const std::filesystem::path& folder);

}  // namespace holdfast::test
