#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/frame/plane.h"

namespace holdfast {

/// Width and height of an image, pixels.
struct ImageSize {
  int width = 0;
  int height = 0;
};

/// How an EXR file is written.
struct ExrOptions {
  /// Store real channels as half instead of float: half the bytes, 11 bits of precision, range
  /// 6e-8..65504. Ids are uint either way.
  bool half = false;
};

/// Reads every channel of an EXR file into the planes that the channel names say.
///
/// Reals may be half or float, ids uint; each channel is read in its own type, so that ids keep all
/// 32 bits. Scanlines or tiles, any compression. Values are passed on as they are, NaN and infinity
/// included.
/// `size`: the size that the file must have; any size if absent.
/// Throws InputError that names the file and the channel when: the file is missing, is no flat
/// single-part image, or is damaged; it has another size; a channel is not in the format; a real is
/// uint or an id is not; a plane lacks one of its channels.
PlaneSet read_exr(const std::filesystem::path& file, std::optional<ImageSize> size = {});

/// The planes of an EXR file, from its header alone; the same checks and errors as `read_exr`.
std::vector<PlaneId> exr_planes(const std::filesystem::path& file,
                                std::optional<ImageSize> size = {});

/// Writes the planes, all of one size, as one EXR file: ZIP-compressed scanlines, reals as float
/// (or half), ids as uint. Replaces an existing file. Throws InputError for no planes or planes of
/// different sizes, std::runtime_error if the file cannot be written.
void write_exr(const std::filesystem::path& file, const PlaneSet& planes, ExrOptions options = {});
/// The same for planes of any owner, none of them null.
void write_exr_planes(const std::filesystem::path& file, std::span<const Plane* const> planes,
                      ExrOptions options = {});

}  // namespace holdfast
