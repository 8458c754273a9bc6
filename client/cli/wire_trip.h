#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/frame/plane.h"
#include "proto/plane_coder.h"

namespace holdfast::cli {

/// One column of a wire profile: codings by kind of plane.
using WireCodings = std::array<wire::PlaneCoding, kPlaneKindCount>;

/// Takes planes through a wire profile as both ends of a stream do, without the stream. Keeps its
/// memory. One thread at a time.
class WireTrip {
 public:
  /// `codings`: kept by reference.
  explicit WireTrip(const WireCodings& codings) : codings_(codings) {}

  /// Writes `plane` to blocks, in the place of the plane before.
  void encode(const Plane& plane);
  /// Bytes of the blocks: those of the plane, and what is left of them by the codec.
  std::size_t plain_bytes() const { return plain_bytes_; }
  std::size_t coded_bytes() const;
  /// Reads the blocks into `plane`, of the same id and size.
  void decode(Plane& plane);

  /// All planes of `planes` into `arrived`, as the other end has them. Returns their coded bytes.
  std::size_t carry(const PlaneSet& planes, PlaneSet& arrived);

 private:
  const WireCodings& codings_;
  wire::PlaneCoder coder_;
  wire::PlaneCoding coding_;
  std::size_t plain_bytes_ = 0, used_ = 0;
  std::vector<std::string> blocks_;  ///< the first `used_` of them
};

}  // namespace holdfast::cli
