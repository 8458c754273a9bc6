#pragma once

#include <string>
#include <utility>
#include <vector>

#include "client/measure/motion_picture.h"
#include "core/frame/plane.h"

namespace holdfast::measure {

/// Pictures for people: the plane enlarged to about 960 pixels across, with a strip below that
/// names it and explains its colours. `title` knows what draw_text knows.

/// Motion vectors by the colour wheel, with arrows along them and the wheel as legend.
Picture titled_motion(const Image& motion_px, const Mask& shown, const std::string& title);

/// One channel in false colours from 0 to `top`, with their scale.
Picture titled_values(const Image& values, const Mask& shown, double top, const std::string& title);

/// Where a component was without history: these pixels are red over its grey picture. The title
/// gains their share.
Picture titled_fallback(const Image& history, const Mask& shown, const Plane& component,
                        const std::string& title);

/// The pictures of one component of a result that was made with debug planes, by the ends of their
/// names: "motion", "fallback", "history", "confidence". Throws InputError for a missing plane.
std::vector<std::pair<std::string, Picture>> debug_pictures(const PlaneSet& result,
                                                            Component component, const Mask& shown,
                                                            const std::string& title);

/// The components that a result has debug planes of.
std::vector<Component> debug_components(const PlaneSet& result);

}  // namespace holdfast::measure
