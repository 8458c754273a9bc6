#pragma once

#include <cstdint>
#include <span>

#include "core/frame/guides.h"
#include "core/frame/plane.h"

namespace holdfast {

/// Fills the `composite` plane of `results` from the filtered `signals` in it (visibility, glossy,
/// indirect planes) and the noise-free planes of `input`:
///   sum over lights of unshadowed * visibility + specular * glossy + albedo * indirect + emission
/// Unshadowed light that `input` lacks is taken from `shaded`, which may be empty.
/// Absent albedo and specular count as 1, other absent terms as 0; sky is emission alone. Values of
/// the input planes that are not finite count as 0, larger ones than kLargestRadiance as that.
/// Returns the number of non-finite values written.
std::uint64_t compose(const Guides& guides, std::span<const PlaneId> signals, const PlaneSet& input,
                      const PlaneSet& shaded, PlaneSet& results);

}  // namespace holdfast
