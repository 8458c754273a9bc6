#pragma once

#include <cstdint>

/// Normals and roughness of a row, in the few bits that the next frame needs of them.
namespace holdfast {

/// Normals as points of an octahedron unfolded to a square (Meyer et al. 2010), 16 bits for each
/// of its coordinates; those along an axis stay exact. Roughness in steps of 1/255, where 0 and 1,
/// and nothing else, stay 0 and 1.
struct GuidePacking {
  const float* normal[3];  ///< X, Y, Z; of unit length, or 0
  const float* roughness;  ///< 0..1; null: none
  int count;
  std::uint32_t* packed_normal;    ///< written; of a normal that is 0, anything
  std::uint8_t* packed_roughness;  ///< written, unless `roughness` is null
};
void pack_guides(const GuidePacking& row) noexcept;

/// What the parts of a normal may differ by once it is unpacked: half a step of the square, which
/// is seen from a distance of at least 1/sqrt(3), and rounding.
inline constexpr float kPackedNormalError = 6e-5f;

/// The same again, of unit length; 0 where the depth is 0.
struct GuideUnpacking {
  const float* depth;
  const std::uint32_t* packed_normal;
  const std::uint8_t* packed_roughness;
  int count;
  float* normal[3];
  float* roughness;  ///< null: none
};
void unpack_guides(const GuideUnpacking& row) noexcept;

}  // namespace holdfast
