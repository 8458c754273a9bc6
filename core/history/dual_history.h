#pragma once

#include "core/history/effect_history.h"
#include "core/history/surface_history.h"

namespace holdfast {

/// Fills `out` for the pixels whose surface vector found no history: with taps along the dual
/// motion vector where that leads to a similar surface beside the occluder, else with none (a
/// second failure leaves the spatial filter alone). Of all other pixels nothing is written.
/// Similar: on the receiver's plane with its normal; its id may differ, but is not the occluder's.
/// The occluder is followed by its rigid motion, or, where the client gives motion vectors, by the
/// one that the previous frame had at its pixel.
///   reads guides of both frames, `surface` | writes `out` | halo 1 px in the previous frame
void trace_dual_history(const FramePair& frames, const SurfaceHistory& surface, EffectHistory& out);

}  // namespace holdfast
