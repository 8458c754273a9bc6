#include "client/measure/strip.h"

#include <algorithm>
#include <cmath>

#include "client/measure/label.h"
#include "client/measure/report_pictures.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::measure {
namespace {

constexpr int kZoom = 2, kGap = 8, kLabelScale = 3;
constexpr int kCropWidth = 196, kCropHeight = 150;  // of the frame; 4 * 196 * 2 + 3 * 8 = 1592
constexpr int kLabelHeight = (kGlyphHeight + 4) * kLabelScale;

struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

Image judged_composite(const SequenceReader& sequence, std::int64_t index) {
  const PlaneSet planes = sequence.read_reference(index);
  return judged_image(clean_image(planes.at({PlaneKind::kComposite, {}})).image, Measure::kTonemap);
}

/// The judged frame before `index`, or `index` itself.
std::int64_t frame_before(const SequenceReader& sequence, std::int64_t index) {
  std::int64_t before = index;
  for (const std::int64_t i : sequence.frame_indices())
    if (i < index && sequence.has_reference(i)) before = i;
  return before;
}

/// The crop over which two images differ most in sum; the first of equals.
Crop most_changed(const Image& a, const Image& b) {
  const int width = a.width, height = a.height;
  const auto stride = static_cast<std::size_t>(width) + 1;
  std::vector<double> sums(stride * (static_cast<std::size_t>(height) + 1));
  const auto at = [&](int x, int y) -> double& {
    return sums[static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      double change = 0;
      for (int c = 0; c < a.channels; ++c)
        change +=
            std::abs(static_cast<double>(a.channel(c)[i]) - static_cast<double>(b.channel(c)[i]));
      at(x + 1, y + 1) = change + at(x, y + 1) + at(x + 1, y) - at(x, y);
    }
  Crop best{0, 0, std::min(width, kCropWidth), std::min(height, kCropHeight)};
  double most = -1;
  for (int y = 0; y + best.height <= height; ++y)
    for (int x = 0; x + best.width <= width; ++x) {
      const double sum = at(x + best.width, y + best.height) - at(x, y + best.height) -
                         at(x + best.width, y) + at(x, y);
      if (sum > most) {
        most = sum;
        best.x = x;
        best.y = y;
      }
    }
  return best;
}

/// Copies the crop of `from`, enlarged, with its left edge at `left`, under a label.
void place(Picture& out, int left, const Picture& from, Crop crop, const std::string& label) {
  for (int y = 0; y < crop.height * kZoom; ++y)
    for (int x = 0; x < crop.width * kZoom; ++x) {
      const int source = (crop.y + y / kZoom) * from.width + crop.x + x / kZoom;
      const int target = (kLabelHeight + y) * out.width + left + x;
      std::copy_n(from.rgb.begin() + source * 3, 3, out.rgb.begin() + target * 3);
    }
  draw_text(out, left + 2 * kLabelScale, 2 * kLabelScale, label, kLabelScale);
}

}  // namespace

Picture strip_of(const ReportScene& scene, const std::vector<std::string>& names) {
  const auto layers = scene_pictures(scene);
  const auto composite = std::find_if(
      layers.begin(), layers.end(), [](const LayerPictures& l) { return l.layer == "composite"; });
  if (composite == layers.end())
    throw InputError("results of " + scene.name, "must have a composite", "without one");
  std::vector<const NamedPicture*> chosen;
  for (const NamedPicture& picture : composite->pictures)
    if (picture.name == "noisy" || picture.name == "reference" ||
        std::find(names.begin(), names.end(), picture.name) != names.end())
      chosen.push_back(&picture);

  const SequenceReader sequence(scene.sequence);
  const std::int64_t now = pictured_frame(scene);
  const Crop crop = most_changed(judged_composite(sequence, now),
                                 judged_composite(sequence, frame_before(sequence, now)));
  const int step = crop.width * kZoom + kGap;
  Picture out{
      step * static_cast<int>(chosen.size()) - kGap, kLabelHeight + crop.height * kZoom, {}};
  out.rgb.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 3,
                 28);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    place(out, step * static_cast<int>(i), chosen[i]->picture, crop, chosen[i]->name);
  return out;
}

}  // namespace holdfast::measure
