#pragma once

#include <cstdint>
#include <vector>

#include "core/spatial/guided_filter.h"

namespace holdfast {

/// Weights of the eight taps around each pixel of one frame by its geometry alone: the first two
/// terms of FilterWeights, which all components share. They are found where a pass first asks for
/// them, and kept in 16 bits each for the passes after it: of a mean of equal taps, they are most
/// of the work.
///
/// A weight w in 0..1 is kept as the nearest of w * kOne, so that a mean of values is off by 1e-5
/// of their differences at most. Two weights share a word. Taps outside the image weigh nothing.
class TapWeights {
 public:
  static constexpr float kOne = 65535.0f;
  static constexpr int kSteps = 3;  ///< passes of step 1 to 3 have weights
  static constexpr int kPairs = 4;  ///< words a pixel and step: see Pair

  /// What the two halves of a word are for, the lower first. Up is towards row 0.
  enum Pair {
    kAbove,   ///< left and right in the row above
    kBeside,  ///< left and right in the pixel's row
    kBelow,   ///< left and right in the row below
    kColumn,  ///< above and below
  };

  TapWeights() = default;
  TapWeights(int width, int height, Memory memory = Memory::kOwned);
  static void each_image(auto& w, auto&& visit) { visit(w.words_); }

  static bool has(int step) { return step >= 1 && step <= kSteps; }

  /// Forgets all: before each frame.
  void clear();

  /// Finds the weights of the pixels of row y from x0 to x0 + count - 1 that are not known yet, as
  /// guides, step and weights of `pass` have them. x0 is at the start of a tile of ActivityMap, as
  /// all that begin within a pass are. Rows may be asked for by several threads, each row by one.
  void provide(const FilterPass& pass, int x0, int y, int count);

  /// The words of row y; known where provided.
  const std::uint32_t* row(int step, Pair pair, int y) const {
    return words_[(step - 1) * kPairs + pair].row(y);
  }

 private:
  Channels<std::uint32_t> words_;
  int tiles_ = 0, height_ = 0;       ///< in a row; rows
  std::vector<std::uint8_t> known_;  ///< by step, row and tile
};

}  // namespace holdfast
