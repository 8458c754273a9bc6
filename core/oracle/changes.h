#pragma once

#include <vector>

#include "core/history/light_change.h"
#include "core/oracle/surfaces.h"

namespace holdfast::oracle {

/// history/light_change.h: the tiles in which light has changed.
class Changes {
 public:
  /// Nothing has changed.
  Changes(int width, int height);
  /// `values`: of a history, by channel; `differences`: those minus the frame; `samples`: 0 where
  /// there is no history. `moving`: something moves, so that only bias is estimated.
  Changes(const Surfaces& now, const Image& values, const Image& differences, const Image& samples,
          const LightChangeRule& rule, bool moving);

  bool changed(int x, int y) const { return marked_[index(x / kTile, y / kTile)]; }
  /// The squared bias of history that is expected, in variances of a difference.
  double bias(int x, int y) const { return bias_.at(x, y); }
  double share() const { return share_; }

 private:
  void mark(const Surfaces& now, const Image& values, const Image& differences,
            const Image& samples, const LightChangeRule& rule);
  static constexpr int kTile = LightChange::kTile;
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_, rows_;
  std::vector<bool> marked_;
  Image bias_;  ///< by pixel
  double share_ = 0;
};

}  // namespace holdfast::oracle
