#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "proto/wire_profile.h"

namespace {
std::atomic<std::size_t> allocations{0};
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* p = std::malloc(std::max<std::size_t>(bytes, 1))) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace holdfast::wire {
namespace {

TEST(PlaneCoder, AllocatesNothingAfterTheFirstFrame) {
  std::list<Plane> planes;
  for (const PlaneKind kind : {PlaneKind::kDepth, PlaneKind::kNormal, PlaneKind::kObjectId,
                               PlaneKind::kIndirect, PlaneKind::kAlbedo}) {
    Plane& plane = planes.emplace_back(PlaneId{kind, {}}, 640, 480);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < 480; ++y)
        for (int x = 0; x < 640; ++x) {
          if (plane.is_uint())
            plane.ids().at(x, y) = static_cast<std::uint32_t>(x / 64);
          else
            plane.channel(c).at(x, y) = static_cast<float>(x + y) / 1120.0f;
        }
  }
  PlaneCoder sender, receiver;
  std::string data;
  const auto pass = [&] {
    for (const std::string& name : profile_names())
      for (Plane& plane : planes) {
        const PlaneCoding coding = fitting_coding(plane, find_profile(name)->input);
        const std::size_t size = plane_bytes(plane, coding.format);
        for (std::size_t offset = 0; offset < size;) {
          const std::size_t bytes = sender.encode(plane, coding, offset, data);
          ASSERT_TRUE(receiver.decode(plane, coding, offset, bytes, data));
          offset += bytes;
        }
      }
  };
  allocations = 0;
  pass();
  EXPECT_GT(allocations, 0u) << "the count counts";
  allocations = 0;
  pass();
  EXPECT_EQ(allocations, 0u);
}

}  // namespace
}  // namespace holdfast::wire
