#pragma once

#include <filesystem>

#include "tests/stability/fuzz_damage.h"

namespace holdfast::test {

/// An EXR file of a few small planes (ids, reals as half or float; scanlines or tiles, of any
/// compression), damaged in its header or its pixels or cut off, written to a file in `folder` and
/// read: its planes, then all of it. All of it follows from the seed. A problem is any exception
/// but an InputError that names the file in a message of bounded length, more memory than 24 MiB
/// and three times the image that the header announces, or planes of another size than asked for.
ReadOutcome fuzz_exr(std::uint32_t seed, const std::filesystem::path& folder);

}  // namespace holdfast::test
