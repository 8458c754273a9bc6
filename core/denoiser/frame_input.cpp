#include "core/denoiser/frame_input.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/frame/conventions.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// Calls body(y) -> number of repaired values for every row, and returns their sum.
template <class Body>
std::uint64_t count_rows(int height, const Body& body) {
  std::atomic<std::uint64_t> total{0};
  for_each_row(height, [&](int y) {
    if (const std::uint64_t repaired = body(y)) total += repaired;
  });
  return total;
}

}  // namespace

std::uint64_t load_depth(const Plane& depth, Guides& out) {
  const auto in = depth.channel(0);
  return count_rows(in.height, [&](int y) {
    std::uint64_t repaired = 0;
    for (int x = 0; x < in.width; ++x) {
      const float d = in.at(x, y);
      repaired += std::isnan(d) ? 1 : 0;
      out.depth_normal[0].at(x, y) = is_surface(d) ? d : 0.0f;
    }
    return repaired;
  });
}

std::uint64_t load_normals(const Plane& normal, Guides& out) {
  const auto nx = normal.channel(0), ny = normal.channel(1), nz = normal.channel(2);
  const glm::vec3 towards_camera = -glm::normalize(out.rays.forward);
  return count_rows(nx.height, [&](int y) {
    std::uint64_t repaired = 0;
    for (int x = 0; x < nx.width; ++x) {
      glm::vec3 n(0.0f);
      if (out.depth().at(x, y) > 0.0f) {
        n = {nx.at(x, y), ny.at(x, y), nz.at(x, y)};
        const float length = glm::length(n);
        if (length > 0.0f && std::isfinite(length)) {
          n /= length;
        } else {
          n = towards_camera;
          ++repaired;
        }
      }
      for (int axis = 0; axis < 3; ++axis) out.depth_normal[1 + axis].at(x, y) = n[axis];
    }
    return repaired;
  });
}

void load_ids(const Plane* ids, Channels<std::uint32_t>& out) {
  if (ids == nullptr) return;  // stays 0
  for_each_row(ids->height(),
               [&](int y) { std::copy_n(ids->ids().row(y), ids->width(), out[0].row(y)); });
}

std::uint64_t load_roughness(const Plane& roughness, Guides& out) {
  return count_rows(roughness.height(), [&](int y) {
    std::uint64_t repaired = 0;
    const float* in = roughness.channel(0).row(y);
    float* to = out.roughness[0].row(y);
    for (int x = 0; x < roughness.width(); ++x) {
      const bool usable = in[x] >= 0.0f && in[x] <= 1.0f;
      to[x] = usable ? in[x] : (in[x] < 0.0f ? 0.0f : 1.0f);
      repaired += usable ? 0 : 1;
    }
    return repaired;
  });
}

void load_motion(const Plane& motion, Guides& out) {
  for_each_row(motion.height(), [&](int y) {
    for (int c = 0; c < 2; ++c)
      std::copy_n(motion.channel(c).row(y), motion.width(), out.motion[c].row(y));
  });
}

std::uint64_t load_signal(const Plane& plane, Channels<float>& out) {
  const float unknown = plane.id().kind == PlaneKind::kVisibility ? 1.0f : 0.0f;
  return count_rows(plane.height(), [&](int y) {
    std::uint64_t repaired = 0;
    for (int c = 0; c < plane.channels(); ++c) {
      const float* in = plane.channel(c).row(y);
      float* to = out[c].row(y);
      for (int x = 0; x < plane.width(); ++x) {
        const float v = in[x];
        const bool usable = v >= 0.0f && v <= kLargestRadiance;
        to[x] = usable ? v : (v > 0.0f && std::isfinite(v) ? kLargestRadiance : unknown);
        repaired += usable ? 0 : 1;
      }
    }
    return repaired;
  });
}

}  // namespace holdfast
