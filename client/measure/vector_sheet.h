#pragma once

#include "client/measure/picture.h"
#include "client/measure/vector_meter.h"
#include "client/measure/vector_tracer.h"

namespace holdfast::measure {

/// What vectors bring to the second frame of a pair, for people. First row: the frame before and
/// the frame itself; then a row a vector: what one sample's vectors bring, with fallback, its error
/// map, and that of the mean of all draws. Pixels that nothing leads to are grey in error maps.
Picture vector_sheet(const FollowedPair& pair, ComponentKind kind);

}  // namespace holdfast::measure
