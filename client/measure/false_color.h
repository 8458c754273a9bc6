#pragma once

#include "client/measure/canvas.h"
#include "client/measure/image.h"

namespace holdfast::measure {

/// A share in 0..1 as a colour of rising lightness, dark blue over green to yellow.
Rgb false_color(double share);

/// One channel in false colours, 0 to `top`; pixels where `shown` is 0 are mid-grey, values that
/// are not finite black.
Picture false_color_picture(const Image& values, const Mask& shown, double top);

/// The colours from 0, left, to the top, right.
Picture false_color_bar(int width, int height);

}  // namespace holdfast::measure
