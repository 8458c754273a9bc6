#include "client/scenes/radiance_cache.h"

#include <algorithm>
#include <cmath>

#include "client/scenes/rng.h"

namespace holdfast::scenes {
namespace {

constexpr std::uint32_t kFewSamples = 4;  // fewer: a coarser cell says more

/// The grid is shifted off planes at round coordinates, whose rounding would choose the cell.
constexpr float kOffPlane = 0.37f;  // of a finest cell, along the normal

std::int32_t cell_of(float x) {
  return static_cast<std::int32_t>(std::floor(std::clamp(x, -1e9f, 1e9f)));
}

}  // namespace

RadianceCache::RadianceCache(double coarsest_m)
    : per_m_(static_cast<float>((1 << (kLevels - 1)) / coarsest_m)) {}

std::uint64_t RadianceCache::Key::hash() const {
  const auto word = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
  return mix_bits((word(x) + (word(y) << 32)) ^ (word(z) * 0x9e3779b97f4a7c15ull) ^
                  (std::uint64_t{side} * 0xd1342543de82ef95ull));
}

RadianceCache::Key RadianceCache::finest_key(const CachePlace& place) const {
  const glm::vec3 a = glm::abs(place.normal);
  const int axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
  const bool is_negative = place.normal[axis] < 0.0f;
  glm::vec3 p = place.position * per_m_;
  p[axis] += is_negative ? -kOffPlane : kOffPlane;
  const auto side = static_cast<std::uint32_t>(2 * axis + (is_negative ? 1 : 0));
  return {cell_of(p.x), cell_of(p.y), cell_of(p.z), place.object * 6 + side};
}

const RadianceCache::Cell* RadianceCache::Table::find(const Key& key) const {
  const std::size_t mask = cells.size() - 1;
  for (std::size_t i = key.hash() & mask; cells[i].count > 0; i = (i + 1) & mask)
    if (cells[i].key == key) return &cells[i];
  return nullptr;
}

void RadianceCache::Table::add(const Key& key, std::uint32_t count, const glm::vec3& mean) {
  const std::size_t mask = cells.size() - 1;
  std::size_t i = key.hash() & mask;
  while (cells[i].count > 0 && cells[i].key != key) i = (i + 1) & mask;
  Cell& cell = cells[i];
  const bool is_new = cell.count == 0;
  cell.key = key;
  cell.count += count;
  const float share = static_cast<float>(count) / static_cast<float>(cell.count);
  cell.mean += share * (mean - cell.mean);
  if (is_new && 2 * ++used > cells.size()) grow();
}

void RadianceCache::Table::grow() {
  std::vector<Cell> old(2 * cells.size());
  old.swap(cells);
  used = 0;
  for (const Cell& cell : old)
    if (cell.count > 0) add(cell.key, cell.count, cell.mean);
}

void RadianceCache::add(const CachePlace& place, const glm::vec3& radiance) {
  levels_[0].add(finest_key(place), 1, radiance);
}

void RadianceCache::finish() {
  for (std::size_t level = 1; level < kLevels; ++level)
    for (const Cell& cell : levels_[level - 1].cells) {
      if (cell.count == 0) continue;
      const Key key{cell.key.x >> 1, cell.key.y >> 1, cell.key.z >> 1, cell.key.side};
      levels_[level].add(key, cell.count, cell.mean);
    }
}

const glm::vec3* RadianceCache::find(const CachePlace& place, float size_m) const {
  const float finest_cells = std::clamp(size_m * per_m_, 1.0f, float{1 << (kLevels - 1)});
  const Key finest = finest_key(place);
  const glm::vec3* found = nullptr;
  for (int level = std::ilogb(finest_cells); level < kLevels; ++level) {
    const Key key{finest.x >> level, finest.y >> level, finest.z >> level, finest.side};
    const Cell* cell = levels_[static_cast<std::size_t>(level)].find(key);
    if (cell) found = &cell->mean;
    if (cell && cell->count >= kFewSamples) break;
  }
  return found;
}

}  // namespace holdfast::scenes
