#pragma once

#include "core/frame/plane.h"

namespace holdfast {

/// Fills the debug planes of `component` in `results`, of width x height pixels, from what a
/// temporal pass has recorded by DebugChannel: images of that size or, `halved`, of half of it.
void write_debug_planes(const Channels<float>& recorded, bool halved, Component component,
                        int width, int height, PlaneSet& results);

}  // namespace holdfast
