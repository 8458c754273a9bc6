#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/frame/plane.h"
#include "proto/plane_coder.h"

namespace holdfast::wire {

/// A named set of codings, one for each kind of plane and direction. A format is a wish: each frame
/// uses the first one, from it to the wider ones, that holds its values (see fitting_format).
struct WireProfile {
  std::string_view name;
  std::array<PlaneCoding, kPlaneKindCount> input;   ///< to the server, by kind
  std::array<PlaneCoding, kPlaneKindCount> result;  ///< from the server, by kind
};

/// The profile of that name; null if there is none.
const WireProfile* find_profile(std::string_view name);
/// "exact", the default; "balanced"; "compact".
const std::vector<std::string>& profile_names();
/// Today's and everybody's default: full formats, no codec.
const WireProfile& exact_profile();

/// The coding of `plane` with these values by one column of a profile.
PlaneCoding fitting_coding(const Plane& plane,
                           const std::array<PlaneCoding, kPlaneKindCount>& codings);

}  // namespace holdfast::wire
