#pragma once

#include "client/scenes/view.h"
#include "core/frame/plane.h"

namespace holdfast::scenes {

/// Converged visibility, as `LightTarget` defines it, of light `light` (an index) in every pixel; 1
/// for sky. Sampling as `render_reference` states.
void render_reference_visibility(const View& view, std::size_t light, int spp,
                                 ChannelView<float> out);

}  // namespace holdfast::scenes
