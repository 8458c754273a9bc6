#pragma once

#include <cstdint>

#include "client/cli/render.h"
#include "core/frame/plane.h"

namespace holdfast::cli {

/// Renders the sequence `render.out` and notes its settings beside it as `render.json`. With
/// `reuse`, a sequence that is there already is kept. Throws InputError if that one was rendered
/// with other settings, as far as these are noted; otherwise as `render_sequence` does.
void provide_sequence(const RenderOptions& render, bool reuse);

/// A second reference of frame `frame`: the same but for its random numbers. It is kept in the
/// folder `second` beside the sequence, and rendered if it is not there. Throws as rendering does.
PlaneSet second_reference(const RenderOptions& render, std::int64_t frame);

}  // namespace holdfast::cli
