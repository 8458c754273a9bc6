#include "core/frame/plane.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "core/frame/error.h"

namespace holdfast {

std::ptrdiff_t padded_stride(int width) {
  constexpr std::ptrdiff_t kLine = 16;  // values of 4 bytes in a cache line of 64 bytes
  constexpr std::ptrdiff_t kFew = 16;   // lines: images so narrow are small, and stay so
  // An odd number of lines: the rows of a column lie in different cache sets, and so do, at heights
  // that are a multiple of 16 but not of 64, channels of one image. (At 480x64, whose channels were
  // multiples of 4096 bytes apart, a filter pass over seven took half as long again.)
  const std::ptrdiff_t lines = (width + kLine - 1) / kLine;
  if (lines < kFew) return lines * kLine;
  return ((width + kApron + kLine - 1) / kLine | 1) * kLine;
}

AlignedBuffer::AlignedBuffer(std::size_t bytes, Memory memory)
    : data_(nullptr, Free{memory}), size_(bytes) {
  if (memory == Memory::kLent) return;
  data_.reset(static_cast<std::byte*>(
      ::operator new (std::max<std::size_t>(bytes, 64), std::align_val_t{64})));
  std::memset(data_.get(), 0, bytes);
}

Plane::Plane(PlaneId id, int width, int height, Memory memory)
    : id_(id), width_(width), height_(height) {
  if (width < 1 || height < 1 || width > kMaxDimension || height > kMaxDimension)
    throw InputError("plane " + plane_name(id),
                     "must have width and height in 1.." + std::to_string(kMaxDimension),
                     std::to_string(width) + "x" + std::to_string(height));
  storage_ = Channels<std::uint32_t>(width, height, channels(), memory);
}

ChannelView<float> Plane::channel(int c) {
  assert(!is_uint());
  const auto view = storage_[c];
  return {reinterpret_cast<float*>(view.data), view.width, view.height, view.stride};
}

ChannelView<const float> Plane::channel(int c) const {
  assert(!is_uint());
  const auto view = storage_[c];
  return {reinterpret_cast<const float*>(view.data), view.width, view.height, view.stride};
}

ChannelView<std::uint32_t> Plane::ids() {
  assert(is_uint());
  return storage_[0];
}

ChannelView<const std::uint32_t> Plane::ids() const {
  assert(is_uint());
  return storage_[0];
}

ChannelView<std::uint32_t> Plane::words(int c) { return storage_[c]; }
ChannelView<const std::uint32_t> Plane::words(int c) const { return storage_[c]; }

const Plane* PlaneSet::find(PlaneId id) const {
  const auto it = std::find_if(planes_.begin(), planes_.end(),
                               [&](const Plane& plane) { return plane.id() == id; });
  return it == planes_.end() ? nullptr : &*it;
}

Plane* PlaneSet::find(PlaneId id) {
  return const_cast<Plane*>(static_cast<const PlaneSet*>(this)->find(id));
}

const Plane& PlaneSet::at(PlaneId id) const {
  if (const Plane* plane = find(id)) return *plane;
  throw InputError("plane " + plane_name(id), "must be present", "missing");
}

Plane& PlaneSet::add(PlaneId id, int width, int height, Memory memory) {
  if (Plane* plane = find(id)) {
    if (plane->width() != width || plane->height() != height)
      *plane = Plane(id, width, height, memory);
    return *plane;
  }
  return planes_.emplace_back(id, width, height, memory);
}

void PlaneSet::remove(PlaneId id) {
  std::erase_if(planes_, [&](const Plane& plane) { return plane.id() == id; });
}

}  // namespace holdfast
