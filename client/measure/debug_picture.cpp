#include "client/measure/debug_picture.h"

#include <algorithm>

#include "client/measure/false_color.h"
#include "client/measure/judged.h"
#include "client/measure/label.h"

namespace holdfast::measure {
namespace {

constexpr int kWheelRadius = 34, kMargin = 8, kTextScale = 2, kBarHeight = 14;
constexpr int kLine = (kGlyphHeight + 3) * kTextScale;
constexpr int kLeastWidth = 640;  ///< so that titles find room

int zoom_of(int width) { return std::max(1, 960 / std::max(width, 1)); }

/// A plane, enlarged, above a strip of `strip` rows.
Picture framed(const Picture& plane, int strip) {
  const int zoom = zoom_of(plane.width);
  Picture out = blank(std::max(plane.width * zoom, kLeastWidth), plane.height * zoom + strip);
  paste(out, plane, 0, 0, zoom);
  return out;
}

void write(Picture& picture, int x, int y, const std::string& text) {
  draw_text(picture, x, y, text, kTextScale);
}

}  // namespace

Picture titled_motion(const Image& motion_px, const Mask& shown, const std::string& title) {
  const double scale = motion_scale(motion_px, shown);
  const int zoom = zoom_of(motion_px.width), top = motion_px.height * zoom;
  Picture plane = blank(motion_px.width * zoom, top);
  paste(plane, motion_picture(motion_px, shown, scale), 0, 0, zoom);
  draw_motion_arrows(plane, motion_px, shown, scale, zoom);
  Picture out = blank(std::max(plane.width, kLeastWidth), top + 2 * (kWheelRadius + kMargin));
  paste(out, plane, 0, 0, 1);
  paste(out, motion_wheel(kWheelRadius), kMargin, top + kMargin, 1);
  const int x = 2 * (kWheelRadius + kMargin);
  write(out, x, top + kMargin, title);
  write(out, x, top + kMargin + kLine, "rim of the wheel " + scale_text(scale) + " px, white 0");
  write(out, x, top + kMargin + 2 * kLine, "arrows point to where it was before");
  return out;
}

Picture titled_values(const Image& values, const Mask& shown, double top,
                      const std::string& title) {
  Picture out = framed(false_color_picture(values, shown, top), 2 * kLine + 3 * kMargin);
  const int y = values.height * zoom_of(values.width) + kMargin;
  write(out, kMargin, y, title);
  const int bar = y + kLine + kMargin / 2, left = kMargin + text_width("0 ", kTextScale);
  write(out, kMargin, bar, "0");
  paste(out, false_color_bar(256, kBarHeight), left, bar, 1);
  write(out, left + 256 + kMargin, bar, scale_text(top));
  return out;
}

Picture titled_fallback(const Image& history, const Mask& shown, const Plane& component,
                        const std::string& title) {
  constexpr Rgb kRed{235, 40, 40};
  Picture plane = picture_of(component);
  std::int64_t surface = 0, without = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) +
                            static_cast<std::size_t>(x);
      const int sum = plane.rgb[3 * i] + plane.rgb[3 * i + 1] + plane.rgb[3 * i + 2];
      const auto grey = static_cast<std::uint8_t>(sum / 3);
      const bool none = shown[i] && !(history.channel(0)[i] > 0);
      set_pixel(plane, x, y, none ? kRed : Rgb{grey, grey, grey});
      surface += shown[i] ? 1 : 0;
      without += none ? 1 : 0;
    }
  Picture out = framed(plane, kLine + 2 * kMargin);
  const double percent =
      100 * static_cast<double>(without) / static_cast<double>(std::max<std::int64_t>(surface, 1));
  write(out, kMargin, history.height * zoom_of(history.width) + kMargin,
        title + ", red " + scale_text(percent) + "%");
  return out;
}

std::vector<std::pair<std::string, Picture>> debug_pictures(const PlaneSet& result,
                                                            Component component, const Mask& shown,
                                                            const std::string& title) {
  const auto image = [&](PlaneKind kind) {
    return clean_image(result.at({kind, component})).image;
  };
  const Image history = image(PlaneKind::kDebugHistory);
  float longest = 0;
  for (std::size_t i = 0; i < history.pixels(); ++i)
    if (shown[i]) longest = std::max(longest, history.values[i]);
  const double top = round_scale(std::max(1.0, static_cast<double>(longest)));
  return {
      {"motion", titled_motion(image(PlaneKind::kDebugMotion), shown, title + " motion")},
      {"fallback", titled_fallback(history, shown, result.at(component_plane(component)),
                                   title + " without history")},
      {"history", titled_values(history, shown, top, title + " history in frames")},
      {"confidence",
       titled_values(image(PlaneKind::kDebugConfidence), shown, 1, title + " weight of history")},
  };
}

std::vector<Component> debug_components(const PlaneSet& result) {
  std::vector<Component> components;
  for (const Plane& plane : result)
    if (plane.id().kind == PlaneKind::kDebugMotion) components.push_back(plane.id().component);
  std::sort(components.begin(), components.end());
  return components;
}

}  // namespace holdfast::measure
