#pragma once

#include <vector>

#include "core/history/component_history.h"

namespace holdfast {

/// How many samples are behind the pixels of an image.
class SampleCount {
 public:
  SampleCount() = default;
  explicit SampleCount(int height);

  ///   reads guides, history | halo 0
  void measure(const Guides& guides, const ComponentHistory& history);

  /// Mean over surface pixels.
  double mean() const { return pixels_ > 0 ? samples_ / pixels_ : 0; }
  /// Mean over those that have a history; 0 if none has.
  double mean_of_known() const { return known_ > 0 ? samples_ / known_ : 0; }

 private:
  struct Row {
    double samples = 0, pixels = 0, known = 0;
  };
  std::vector<Row> rows_;
  double samples_ = 0, pixels_ = 0, known_ = 0;
};

}  // namespace holdfast
