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

  /// Writes frame.####.exr with the planes of `frame.planes`, and gradient.####.exr with those that
  /// are gradients, if there are any. Indices must increase; planes have the size that the header
  /// gives them; numbers are finite; lights are in the header. Throws InputError otherwise.
  void write_frame(const Frame& frame);
  /// Writes reference.####.exr: converged results, under result names.
  void write_reference(std::int64_t index, const PlaneSet& planes);
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
  /// `with_gradients`: also the planes of gradient.####.exr, which every frame has if the first
  /// has.
  Frame read_frame(std::int64_t index, bool with_gradients = false) const;
  /// The planes of the first frame.
  std::vector<PlaneId> planes(bool with_gradients = false) const;

  bool has_reference(std::int64_t index) const;
  PlaneSet read_reference(std::int64_t index) const;
  /// True if the sequence has gradient planes: if its first frame has.
  bool has_gradients() const;

 private:
  ImageSize size() const { return {header_.width, header_.height}; }
  ImageSize gradient_size() const;

  std::filesystem::path dir_;
  SequenceHeader header_;
  std::vector<Frame> frames_;  ///< without planes
};

/// DIR/frame.0007.exr for kind "frame" and index 7; results use the same names.
std::filesystem::path sequence_file(const std::filesystem::path& dir, const char* kind,
                                    std::int64_t index);

}  // namespace holdfast
