#include "client/cli/wire_trip.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "proto/wire_profile.h"

namespace holdfast::cli {

void WireTrip::encode(const Plane& plane) {
  coding_ = wire::fitting_coding(plane, codings_);
  plain_bytes_ = wire::plane_bytes(plane, coding_.format);
  used_ = (plain_bytes_ + wire::kMaxChunkBytes - 1) / wire::kMaxChunkBytes;
  if (blocks_.size() < used_) blocks_.resize(used_);
  for (std::size_t i = 0; i < used_; ++i)
    coder_.encode(plane, coding_, i * wire::kMaxChunkBytes, blocks_[i]);
}

std::size_t WireTrip::coded_bytes() const {
  return std::accumulate(
      blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(used_), std::size_t{0},
      [](std::size_t sum, const std::string& block) { return sum + block.size(); });
}

void WireTrip::decode(Plane& plane) {
  for (std::size_t i = 0; i < used_; ++i) {
    const std::size_t offset = i * wire::kMaxChunkBytes;
    const std::size_t held = std::min(wire::kMaxChunkBytes, plain_bytes_ - offset);
    if (!coder_.decode(plane, coding_, offset, held, blocks_[i]))
      throw std::logic_error("a block cannot be decoded");
  }
}

std::size_t WireTrip::carry(const PlaneSet& planes, PlaneSet& arrived) {
  std::size_t bytes = 0;
  for (const Plane& plane : planes) {
    encode(plane);
    bytes += coded_bytes();
    decode(arrived.add(plane.id(), plane.width(), plane.height()));
  }
  return bytes;
}

}  // namespace holdfast::cli
