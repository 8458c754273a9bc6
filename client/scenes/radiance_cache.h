#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace holdfast::scenes {

/// A place on a surface, as a ray found it. World space, metres.
struct CachePlace {
  std::uint32_t object = 0;  ///< index in Scene::objects
  glm::vec3 position{0.0f};
  glm::vec3 normal{0.0f};  ///< of the triangle, of any length, on the ray's side
};

/// The radiance that surfaces send out, diffusely, as means over the cells of a grid: one per
/// object and per axis that the normal is nearest to. Four levels of grids, from coarsest / 8 up; a
/// coarser cell is the mean of the samples of those in it. Its content depends on the order of
/// `add`, to rounding.
class RadianceCache {
 public:
  /// `coarsest_m`: edge of the coarsest cells, > 0.
  explicit RadianceCache(double coarsest_m);

  /// Adds a sample to the finest level.
  void add(const CachePlace& place, const glm::vec3& radiance);
  /// Fills the coarser levels; to be called once, after the last `add`.
  void finish();

  /// The mean at a place over the largest cells of at most `size_m` metres (at least the finest)
  /// that hold 4 samples, or a larger cell where there are fewer; null where even the coarsest has
  /// none.
  const glm::vec3* find(const CachePlace& place, float size_m) const;

 private:
  static constexpr int kLevels = 4;

  struct Key {
    std::int32_t x = 0, y = 0, z = 0;
    std::uint32_t side = 0;  // object and axis

    bool operator==(const Key&) const = default;
    std::uint64_t hash() const;
  };
  struct Cell {
    Key key;
    std::uint32_t count = 0;  // 0 = free
    glm::vec3 mean{0.0f};
  };
  /// Open addressing, at most half full.
  struct Table {
    std::vector<Cell> cells = std::vector<Cell>(1024);
    std::size_t used = 0;

    const Cell* find(const Key& key) const;
    void add(const Key& key, std::uint32_t count, const glm::vec3& mean);
    void grow();
  };

  Key finest_key(const CachePlace& place) const;

  float per_m_;  // finest cells
  std::array<Table, kLevels> levels_;
};

}  // namespace holdfast::scenes
