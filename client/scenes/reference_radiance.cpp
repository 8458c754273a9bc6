#include "client/scenes/reference_radiance.h"

#include <algorithm>
#include <cmath>

#include "client/scenes/glossy.h"
#include "client/scenes/path.h"
#include "client/scenes/sampling.h"
#include "core/kernels/parallel.h"

namespace holdfast::scenes {
namespace {

// Apart from the streams of noisy frames.
enum Stream : std::uint64_t { kGlossyStream = 1ull << 32, kIndirectStream, kCacheStream };

constexpr double kCellAngle = 1.0 / 32.0;  // radians: coarser cells would blur what lights a pixel
constexpr int kPathShare = 16;             // of samples to the paths that fill the cache
constexpr int kRowsAtOnce = 8;             // whose paths wait to be added, in order

struct CacheSample {
  CachePlace place;
  glm::vec3 radiance;
};

CachePlace place_of(const Hit& hit) {
  return {static_cast<std::uint32_t>(hit.object), glm::vec3(hit.position),
          glm::vec3(hit.geometric_normal)};
}

}  // namespace

ReferenceRadiance::ReferenceRadiance(const View& view, int spp)
    : view_(view), spp_(spp), cache_(kCellAngle * typical_distance()) {
  if (view.scene.components.indirect) fill_cache();
}

std::uint64_t ReferenceRadiance::seed_of(int x, int y, std::uint64_t stream) const {
  const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(view_.width) +
                     static_cast<std::uint64_t>(x);
  return Rng(view_.seed, 0, pixel, stream).bits();
}

/// The median length in metres of some secondary rays; 1 if none meets anything.
double ReferenceRadiance::typical_distance() const {
  constexpr int kRows = 64;
  std::vector<double> found;
  for (int i = 0; i < kRows * kRows; ++i) {
    const int x = (i % kRows) * view_.width / kRows, y = (i / kRows) * view_.height / kRows;
    const auto primary = primary_at(view_, x, y);
    if (!primary) continue;
    const Surface& surface = primary->surface;
    const glm::dvec3 direction =
        sample_cosine(surface.normal, sobol_point(static_cast<std::uint32_t>(i), view_.seed));
    const auto hit = view_.world.nearest(surface.origin, direction, 1e30);
    if (hit) found.push_back(hit->distance_m);
  }
  if (found.empty()) return 1.0;
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return std::max(1e-6, *middle);
}

void ReferenceRadiance::fill_cache() {
  const int paths = (spp_ + kPathShare - 1) / kPathShare;
  std::vector<std::vector<CacheSample>> rows(kRowsAtOnce);
  for (int top = 0; top < view_.height; top += kRowsAtOnce) {
    const int end = std::min(view_.height, top + kRowsAtOnce);
    for_each_index(top, end, 1, [&](int y) {
      std::vector<CacheSample>& row = rows[static_cast<std::size_t>(y - top)];
      row.clear();
      for (int x = 0; x < view_.width; ++x) {
        const auto primary = primary_at(view_, x, y);
        if (!primary) continue;
        const std::uint64_t seed = seed_of(x, y, kCacheStream);
        for (int i = 0; i < paths; ++i) {
          PathPoints points(seed, static_cast<std::uint32_t>(i));
          const glm::dvec3 direction = sample_cosine(primary->surface.normal, points.next2());
          const Incident found = trace_path(view_.scene, view_.world, view_.lights,
                                            primary->surface.origin, direction, points);
          if (found.hit) row.push_back({place_of(*found.hit), glm::vec3(found.radiance)});
        }
      }
    });
    for (int y = top; y < end; ++y)
      for (const CacheSample& sample : rows[static_cast<std::size_t>(y - top)])
        cache_.add(sample.place, sample.radiance);
  }
  cache_.finish();
}

glm::dvec3 ReferenceRadiance::glossy(int x, int y, const Surface& surface) const {
  if (!surface.has_lobe()) return glm::dvec3(0.0);
  const std::uint64_t seed = seed_of(x, y, kGlossyStream);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < spp_; ++i) {
    PathPoints points(seed, static_cast<std::uint32_t>(i));
    const LobeSample lobe = sample_lobe(surface, points.next2());
    if (lobe.direction == glm::dvec3(0.0)) continue;
    sum += lobe.weight * trace_path(view_.scene, view_.world, view_.lights, surface.origin,
                                    lobe.direction, points)
                             .radiance;
  }
  return sum / static_cast<double>(spp_);
}

glm::dvec3 ReferenceRadiance::indirect(int x, int y, const Surface& surface) const {
  const std::uint64_t seed = seed_of(x, y, kIndirectStream);
  const int batches = (spp_ + RayBatch::kSize - 1) / RayBatch::kSize;
  glm::dvec3 sum(0.0);
  RayBatch rays;
  HitBatch hits;
  for (int batch = 0; batch < batches; ++batch) {
    const auto first = static_cast<std::uint32_t>(batch * RayBatch::kSize);
    for (std::uint32_t i = 0; i < RayBatch::kSize; ++i) {
      const glm::vec3 d(sample_cosine(surface.normal, sobol_point(first + i, seed)));
      rays.x[i] = d.x, rays.y[i] = d.y, rays.z[i] = d.z;
      rays.length[i] = 1e30f;
    }
    view_.world.nearest(surface.origin, rays, hits);
    for (std::uint32_t i = 0; i < RayBatch::kSize; ++i) {
      PathPoints points(seed, first + i);
      sum += gathered(surface, {rays.x[i], rays.y[i], rays.z[i]}, hits.at(i), points);
    }
  }
  return sum / static_cast<double>(batches * RayBatch::kSize);
}

/// Radiance along one ray of a batch: from the cache, or of a path where it knows nothing.
glm::dvec3 ReferenceRadiance::gathered(const Surface& surface, const glm::vec3& direction,
                                       const HitBatch::Hit& hit, PathPoints& points) const {
  if (hit.object == HitBatch::kNone) return view_.scene.sky.radiance(direction);
  const bool is_back = glm::dot(hit.normal, direction) > 0.0f;
  const CachePlace place{hit.object, glm::vec3(surface.origin) + hit.distance * direction,
                         is_back ? -hit.normal : hit.normal};
  const glm::vec3* cached = cache_.find(place, hit.distance * static_cast<float>(kCellAngle));
  if (cached) return *cached;
  return trace_path(view_.scene, view_.world, view_.lights, surface.origin, glm::dvec3(direction),
                    points)
      .radiance;
}

}  // namespace holdfast::scenes
