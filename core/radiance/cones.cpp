#include "core/radiance/cones.h"

#include <algorithm>
#include <array>

namespace holdfast {
namespace {

constexpr int kSteps = 480;  // of an eighth of a degree: overlaps end like (2r - d)^1.5

std::array<float, kSteps + 1> make_table() {
  std::array<float, kSteps + 1> table{};
  for (int i = 0; i <= kSteps; ++i)
    table[static_cast<std::size_t>(i)] =
        static_cast<float>(cone_overlap(2 * kConeHalfAngle * i / kSteps, kConeHalfAngle));
  return table;
}

}  // namespace

float tabulated_cone_overlap(float cosine) {
  static const std::array<float, kSteps + 1> table = make_table();
  constexpr auto kPerRadian = static_cast<float>(kSteps / (2 * kConeHalfAngle));
  const float place = std::acos(std::clamp(cosine, -1.0f, 1.0f)) * kPerRadian;
  if (!(place < static_cast<float>(kSteps))) return 0.0f;
  const auto i = static_cast<std::size_t>(place);
  const float t = place - static_cast<float>(i);
  return (1.0f - t) * table[i] + t * table[i + 1];
}

ConeMix::ConeMix(const ConeFrame<float>& from, const ConeFrame<float>& to) {
  glm::vec3 axes[kCones];
  for (int k = 0; k < kCones; ++k) axes[k] = to.axis(k);
  for (int j = 0; j < kCones; ++j) {
    const glm::vec3 axis = from.axis(j);
    float sum = 0;
    for (int k = 0; k < kCones; ++k) {
      share[k][j] = tabulated_cone_overlap(glm::dot(axes[k], axis));
      sum += share[k][j];
    }
    for (int k = 0; k < kCones; ++k) share[k][j] = sum > 0.0f ? share[k][j] / sum : 0.0f;
  }
}

}  // namespace holdfast
