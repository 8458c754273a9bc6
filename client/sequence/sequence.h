#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "client/sequence/exr.h"
#include "core/frame/frame.h"

namespace holdfast {

/// What holds for a whole sequence; the top of sequence.json.
struct SequenceHeader {
  int width = 0;           ///< pixels, 1..kMaxDimension
  int height = 0;          ///< pixels, 1..kMaxDimension
  double frame_rate = 30;  ///< frames a second, > 0
  std::vector<Light> lights;
  std::vector<std::pair<std::uint32_t, std::string>> objects;  ///< id and name, for messages only
};

/// Writes a sequence: DIR/frame.####.exr and friends at once, DIR/sequence.json at the end.
class SequenceWriter {
 public:
  /// Creates `dir`. If it holds a sequence already, that sequence's files are removed, so that an
  /// old reference is never taken for one of the new frames. Throws InputError for a bad header.
  SequenceWriter(std::filesystem::path dir, SequenceHeader header, ExrOptions options = {});

  /// Writes frame.####.exr with all planes of `frame.planes`. Indices must increase; planes have
  /// the header's size; numbers are finite; lights are in the header. Throws InputError otherwise.
  void write_frame(const Frame& frame);
  /// Writes reference.####.exr: converged results, under result names.
  void write_reference(std::int64_t index, const PlaneSet& planes);
  /// Writes gradient.####.exr: gradient planes of ceil(width/3) x ceil(height/3).
  void write_gradient(std::int64_t index, const PlaneSet& planes);
  /// Writes sequence.json with the frames so far. May be called again after more frames.
  void finish();

 private:
  std::filesystem::path dir_;
  SequenceHeader header_;
  ExrOptions options_;
  std::vector<Frame> frames_;  ///< without planes
};

/// Reads a sequence. Every error is an InputError that names the file, the key or channel, the rule
/// and the value found.
class SequenceReader {
 public:
  /// Reads and checks sequence.json; frame files are opened on demand.
  explicit SequenceReader(std::filesystem::path dir);

  const std::filesystem::path& dir() const { return dir_; }
  const SequenceHeader& header() const { return header_; }
  /// Frame indices in the order of sequence.json, strictly increasing; any start, gaps allowed.
  std::vector<std::int64_t> frame_indices() const;
  /// A frame with its planes (depth and normal at least), camera and the transforms it lists.
  Frame read_frame(std::int64_t index) const;
  /// The planes of the first frame.
  std::vector<PlaneId> planes() const;

  bool has_reference(std::int64_t index) const;
  PlaneSet read_reference(std::int64_t index) const;
  bool has_gradient(std::int64_t index) const;
  PlaneSet read_gradient(std::int64_t index) const;

 private:
  ImageSize size() const { return {header_.width, header_.height}; }

  std::filesystem::path dir_;
  SequenceHeader header_;
  std::vector<Frame> frames_;  ///< without planes
};

/// DIR/frame.0007.exr for kind "frame" and index 7; results use the same names.
std::filesystem::path sequence_file(const std::filesystem::path& dir, const char* kind,
                                    std::int64_t index);

/// Size of the gradient planes of a frame: one sample for each 3x3 stratum.
inline ImageSize gradient_size(ImageSize frame) {
  return {(frame.width + 2) / 3, (frame.height + 2) / 3};
}

}  // namespace holdfast
