#pragma once

#include "client/measure/canvas.h"
#include "client/measure/image.h"

namespace holdfast::measure {

/// The colour of a motion vector: hue says the direction (right red, down green-yellow, left cyan,
/// up violet, as the wheel of `motion_wheel` shows), saturation the length. White is no motion,
/// full colour `scale_px` and more; what is not finite is black.
Rgb motion_color(double x_px, double y_px, double scale_px);

/// Motion in pixels, two channels, as colours; pixels where `shown` is 0 are mid-grey.
Picture motion_picture(const Image& motion_px, const Mask& shown, double scale_px);

/// Draws arrows along the motion over a picture of it that is `zoom` times as large, one every 24
/// pixels of the picture. An arrow of `scale_px` is as long as their distance.
void draw_motion_arrows(Picture& picture, const Image& motion_px, const Mask& shown,
                        double scale_px, int zoom);

/// The colours of all vectors up to `scale`: a disk of this radius on black.
Picture motion_wheel(int radius);

/// A round length that 95 % of the shown vectors of more than 0.01 px do not exceed, pixels.
double motion_scale(const Image& motion_px, const Mask& shown);

}  // namespace holdfast::measure
