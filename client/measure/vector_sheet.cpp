#include "client/measure/vector_sheet.h"

#include <string>

#include "client/measure/canvas.h"
#include "client/measure/label.h"

namespace holdfast::measure {
namespace {

constexpr int kZoom = 2, kGap = 6, kLabelScale = 2;
constexpr int kLabelHeight = (kGlyphHeight + 3) * kLabelScale;

/// A sheet of tiles under labels.
class Sheet {
 public:
  Sheet(int width, int height, int columns, int rows)
      : step_x_(width * kZoom + kGap),
        step_y_(height * kZoom + kLabelHeight),
        picture_(blank(step_x_ * columns - kGap, step_y_ * rows)) {}
  void place(int column, int row, const Picture& tile, const std::string& label) {
    paste(picture_, tile, column * step_x_, row * step_y_ + kLabelHeight, kZoom);
    draw_text(picture_, column * step_x_ + kLabelScale, row * step_y_ + kLabelScale, label,
              kLabelScale);
  }
  Picture take() { return std::move(picture_); }

 private:
  int step_x_, step_y_;
  Picture picture_;
};

}  // namespace

Picture vector_sheet(const FollowedPair& pair, ComponentKind kind) {
  const Plane previous = mean_of(pair.previous), now = mean_of(pair.now);
  const auto vectors = vectors_of(kind);
  Sheet sheet(now.width(), now.height(), 3, 1 + static_cast<int>(vectors.size()));
  sheet.place(0, 0, picture_of(previous), "the frame before");
  sheet.place(1, 0, picture_of(now), "the frame");
  sheet.place(2, 0, error_map(previous, now, pair.region), "their difference");
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    const int row = 1 + static_cast<int>(v);
    const std::string name(vector_name(vectors[v]));
    Plane mean(now.id(), now.width(), now.height());
    Mask always = pair.region;
    for (std::size_t d = 0; d < pair.taps.size(); ++d) {
      const Warped warped = warp(previous, pair.taps[d][v][0], pair.taps[d][0][0]);
      for (std::size_t i = 0; i < always.size(); ++i) always[i] = always[i] && warped.found[i];
      add_share(mean, warped.image, 1.0f / static_cast<float>(pair.taps.size()));
      if (d > 0) continue;
      sheet.place(0, row, picture_of(warped.image), name);
      sheet.place(1, row, error_map(warped.image, now, always), name + ", error");
    }
    sheet.place(2, row, error_map(mean, now, always), name + ", error of the mean");
  }
  return sheet.take();
}

}  // namespace holdfast::measure
