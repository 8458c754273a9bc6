#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace holdfast {

/// What is filtered on its own, with a motion vector of its own.
enum class ComponentKind : std::uint8_t { kVisibility, kGlossy, kIndirect };

/// One filtered component: the visibility of one light, the glossy reflection, the indirect light.
struct Component {
  ComponentKind kind = ComponentKind::kVisibility;
  std::uint32_t light = 0;  ///< light id; only for kVisibility, else 0

  friend auto operator<=>(const Component&, const Component&) = default;
};

/// "light<k>.visibility", "glossy" or "indirect".
std::string component_name(Component component);

/// Every kind of plane that a frame, a result or a file can hold.
enum class PlaneKind : std::uint8_t {
  // Geometry and material, input.
  kDepth,
  kNormal,
  kObjectId,
  kRoughness,
  kAlbedo,
  kSpecular,
  kEmission,
  kMotion,
  // Per light, input. kVisibility is also a result.
  kUnshadowed,
  kVisibility,
  kBlockerDistance,
  kBlockerId,
  kLightSample,
  // Glossy, input. kGlossy is also a result.
  kGlossy,
  kGlossyDirection,
  kGlossyHitDistance,
  kGlossyHitId,
  // Indirect, input. kIndirect is also a result.
  kIndirect,
  kIndirectDirection,
  // Gradient samples of a component, input, at ceil(W/3) x ceil(H/3).
  kGradient,
  // Results.
  kComposite,
  kDebugMotion,
  kDebugHistory,
  kDebugConfidence,
};
inline constexpr int kPlaneKindCount = static_cast<int>(PlaneKind::kDebugConfidence) + 1;

enum class ScalarType : std::uint8_t { kFloat, kUint };

/// What is fixed about a kind of plane.
struct PlaneTraits {
  PlaneKind kind;
  std::string_view name;                       ///< with '%' for the light id or the component
  std::span<const std::string_view> channels;  ///< suffixes appended to the name, with their dot
  ScalarType scalar;
  bool per_light;
  bool per_component;
};
const PlaneTraits& plane_traits(PlaneKind kind);

/// A plane's identity: its kind and, where the kind asks for one, its light or component.
struct PlaneId {
  PlaneKind kind = PlaneKind::kDepth;
  Component component{};  ///< light id for per-light kinds; component for gradient and debug kinds

  /// A plane of light `light`, for example {kBlockerId, 2} = "light2.blockerId".
  static PlaneId of_light(PlaneKind kind, std::uint32_t light) {
    return {kind, {ComponentKind::kVisibility, light}};
  }

  friend auto operator<=>(const PlaneId&, const PlaneId&) = default;
};

/// The noisy (and filtered) plane of a component.
PlaneId component_plane(Component component);

/// "normal", "light0.blockerDistance", "debug.glossy.motion": the name without channel suffix.
std::string plane_name(PlaneId id);

/// The plane of that name; nothing if there is no such plane.
std::optional<PlaneId> plane_from_name(std::string_view name);

/// "normal.X", "light0.sampleV", "roughness": the name of one EXR channel.
std::string channel_name(PlaneId id, int channel);

/// Plane and channel index of an EXR channel name; nothing if it is no channel of ours.
struct ChannelRef {
  PlaneId plane;
  int channel;
};
std::optional<ChannelRef> channel_from_name(std::string_view name);

/// Number of channels of a kind of plane, 1..3.
inline int channel_count(PlaneKind kind) {
  return static_cast<int>(plane_traits(kind).channels.size());
}

}  // namespace holdfast
