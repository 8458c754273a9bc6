#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "client/measure/layer_meter.h"

namespace holdfast::measure {

struct CompareOptions {
  std::filesystem::path reference;           ///< a sequence with references
  std::vector<std::filesystem::path> tests;  ///< directories with results as frame.####.exr
  std::vector<std::string> layers;  ///< plane names; empty = all that references and results share
  bool flip = true;                 ///< FLIP takes most of the time
  std::int64_t first = 0, last = std::numeric_limits<std::int64_t>::max();  ///< frames judged
  /// Called at the start and after each judged frame with the frames done and their total.
  std::function<void(std::int64_t done, std::int64_t total)> progress;
};

/// Errors of one result against the references, on the image and on the effect.
struct Comparison {
  std::int64_t frames = 0;      ///< judged
  std::int64_t last_frame = 0;  ///< index of the last one
  struct Layer {
    std::string name;
    Measure measure = Measure::kClip;
    LayerErrors image, effect;
  };
  std::vector<Layer> layers;
};

/// Compares each test with the references of a sequence, as the contract says: errors of judged
/// values (judged.h), sky excluded, pooled over all judged pixels of all judged frames; only frames
/// that have a reference are judged. The answer is in the order of `tests`. Throws InputError that
/// names the file or layer when: the sequence has no reference in range; a result is missing, of
/// another size or without a layer; a layer is unknown; no layer is shared; a reference holds a
/// value that is not finite.
std::vector<Comparison> compare(const CompareOptions& options);

}  // namespace holdfast::measure
