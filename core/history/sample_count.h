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
  double mean() const { return total_.pixels > 0 ? total_.samples / total_.pixels : 0; }
  /// Mean over those that have a history; 0 if none has.
  double mean_of_known() const { return total_.known > 0 ? total_.samples / total_.known : 0; }

 private:
  struct Row {
    double samples = 0, pixels = 0, known = 0;
    void operator+=(const Row& other) {
      samples += other.samples;
      pixels += other.pixels;
      known += other.known;
    }
  };
  std::vector<Row> rows_;
  Row total_;
};

}  // namespace holdfast
