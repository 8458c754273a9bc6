#include "proto/predicted_bytes.h"

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/isa_guard.h"

namespace holdfast::wire {
namespace {

std::vector<std::byte> random_bytes(std::size_t count) {
  std::mt19937 random(1);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

TEST(PredictedBytes, AreTheWrappedDifferencesToTheRowAboveWithTheirBytesApart) {
  // Elements of 2 bytes, 3 a row.
  const std::uint16_t values[] = {1, 2, 0x0304, 0, 0x0202, 0x0204, 5};
  const std::uint16_t expected[] = {1, 2, 0x0304, 0xffff, 0x0200, 0xff00, 5};
  std::vector<std::byte> in(14), out(14);
  std::memcpy(in.data(), values, 14);
  predict_bytes(in.data(), 14, 2, 3, out.data());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(out[i], static_cast<std::byte>(expected[i] & 255)) << i;
    EXPECT_EQ(out[7 + i], static_cast<std::byte>(expected[i] >> 8)) << i;
  }
}

TEST(PredictedBytes, RestoreEveryByteForEveryShapeAndInstructionSet) {
  const test::IsaGuard guard;
  for (const std::size_t element : {1u, 2u, 4u})
    for (const std::size_t width : {1u, 3u, 16u, 37u, 480u, 5000u})
      for (const std::size_t count : {1u, 36u, 37u, 38u, 1000u, 4801u}) {
        const auto bytes = random_bytes(element * count);
        std::vector<std::byte> first;
        for (const Isa isa : available_isas()) {
          select_isa(isa);
          std::vector<std::byte> predicted(bytes.size()), restored(bytes.size());
          predict_bytes(bytes.data(), bytes.size(), element, width, predicted.data());
          restore_bytes(predicted.data(), bytes.size(), element, width, restored.data());
          ASSERT_TRUE(restored == bytes) << element << " " << width << " " << count;
          if (first.empty()) first = predicted;
          ASSERT_TRUE(predicted == first) << isa_name(isa);
        }
      }
}

TEST(PredictedBytes, OfAGradientRepeat) {
  constexpr std::size_t kWidth = 64, kHeight = 16;
  std::vector<std::uint32_t> plane;
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x) plane.push_back(0x3f800000u + 1000 * y + 77 * x);
  std::vector<std::byte> in(4 * plane.size()), out(in.size());
  std::memcpy(in.data(), plane.data(), in.size());
  predict_bytes(in.data(), in.size(), 4, kWidth, out.data());
  for (std::size_t i = kWidth; i < plane.size(); ++i) {
    EXPECT_EQ(out[i], static_cast<std::byte>(1000 & 255));
    EXPECT_EQ(out[plane.size() + i], static_cast<std::byte>(1000 >> 8));
  }
}

}  // namespace
}  // namespace holdfast::wire
