#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/measure/picture.h"
#include "client/measure/report.h"

namespace holdfast::measure {

/// A picture of the page with its error map.
struct NamedPicture {
  std::string name;  ///< "noisy", a result's name or "reference"
  Picture picture, error;
};

/// The pictures of one layer: noisy first, then the results in order, the reference last.
struct LayerPictures {
  std::string layer;
  std::vector<NamedPicture> pictures;
};

/// The last frame that was judged.
std::int64_t pictured_frame(const ReportScene& scene);

/// Pictures of all layers that were compared.
std::vector<LayerPictures> scene_pictures(const ReportScene& scene);

}  // namespace holdfast::measure
