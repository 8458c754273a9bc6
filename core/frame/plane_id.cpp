#include "core/frame/plane_id.h"

#include <array>
#include <charconv>

namespace holdfast {
namespace {

using Suffixes = std::span<const std::string_view>;
constexpr std::array<std::string_view, 1> kSingle{""};
constexpr std::array<std::string_view, 1> kZ{".Z"};
constexpr std::array<std::string_view, 2> kXY{".X", ".Y"};
constexpr std::array<std::string_view, 2> kUV{"U", "V"};
constexpr std::array<std::string_view, 3> kXYZ{".X", ".Y", ".Z"};
constexpr std::array<std::string_view, 3> kRGB{".R", ".G", ".B"};

constexpr PlaneTraits make(PlaneKind kind, std::string_view name, Suffixes channels,
                           ScalarType scalar = ScalarType::kFloat) {
  const bool light = name.starts_with("light%");
  return {kind, name, channels, scalar, light, !light && name.find('%') != name.npos};
}

constexpr std::array<PlaneTraits, kPlaneKindCount> kTraits{
    make(PlaneKind::kDepth, "depth", kZ),
    make(PlaneKind::kNormal, "normal", kXYZ),
    make(PlaneKind::kObjectId, "objectId", kSingle, ScalarType::kUint),
    make(PlaneKind::kRoughness, "roughness", kSingle),
    make(PlaneKind::kAlbedo, "albedo", kRGB),
    make(PlaneKind::kSpecular, "specular", kRGB),
    make(PlaneKind::kEmission, "emission", kRGB),
    make(PlaneKind::kMotion, "motion", kXY),
    make(PlaneKind::kUnshadowed, "light%.unshadowed", kRGB),
    make(PlaneKind::kVisibility, "light%.visibility", kSingle),
    make(PlaneKind::kBlockerDistance, "light%.blockerDistance", kSingle),
    make(PlaneKind::kBlockerId, "light%.blockerId", kSingle, ScalarType::kUint),
    make(PlaneKind::kLightSample, "light%.sample", kUV),
    make(PlaneKind::kGlossy, "glossy", kRGB),
    make(PlaneKind::kGlossyDirection, "glossy.direction", kXYZ),
    make(PlaneKind::kGlossyHitDistance, "glossy.hitDistance", kSingle),
    make(PlaneKind::kGlossyHitId, "glossy.hitId", kSingle, ScalarType::kUint),
    make(PlaneKind::kIndirect, "indirect", kRGB),
    make(PlaneKind::kIndirectDirection, "indirect.direction", kXYZ),
    make(PlaneKind::kGradient, "gradient.%", kXY),
    make(PlaneKind::kComposite, "composite", kRGB),
    make(PlaneKind::kDebugMotion, "debug.%.motion", kXY),
    make(PlaneKind::kDebugHistory, "debug.%.history", kSingle),
    make(PlaneKind::kDebugConfidence, "debug.%.confidence", kSingle),
};

/// Reads a decimal uint32 without sign or leading zeros at the front of `text` and removes it.
std::optional<std::uint32_t> take_number(std::string_view& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto length = static_cast<std::size_t>(end - text.data());
  if (error != std::errc{} || (length > 1 && text.front() == '0')) return std::nullopt;
  text.remove_prefix(length);
  return value;
}

bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

std::optional<Component> take_component(std::string_view& text) {
  if (take_prefix(text, "glossy")) return Component{ComponentKind::kGlossy, 0};
  if (take_prefix(text, "indirect")) return Component{ComponentKind::kIndirect, 0};
  if (!take_prefix(text, "light")) return std::nullopt;
  const auto light = take_number(text);
  if (!light || !take_prefix(text, ".visibility")) return std::nullopt;
  return Component{ComponentKind::kVisibility, *light};
}

/// Matches `name` against the traits' pattern followed by `suffix`.
std::optional<PlaneId> match(const PlaneTraits& traits, std::string_view name,
                             std::string_view suffix) {
  const auto hole = traits.name.find('%');
  if (!take_prefix(name, traits.name.substr(0, hole))) return std::nullopt;
  PlaneId id{traits.kind, {}};
  if (hole != traits.name.npos) {
    if (traits.per_light) {
      const auto light = take_number(name);
      if (!light) return std::nullopt;
      id.component.light = *light;
    } else {
      const auto component = take_component(name);
      if (!component) return std::nullopt;
      id.component = *component;
    }
    if (!take_prefix(name, traits.name.substr(hole + 1))) return std::nullopt;
  }
  if (name != suffix) return std::nullopt;
  return id;
}

}  // namespace

std::string component_name(Component component) {
  switch (component.kind) {
    case ComponentKind::kVisibility:
      return "light" + std::to_string(component.light) + ".visibility";
    case ComponentKind::kGlossy: return "glossy";
    case ComponentKind::kIndirect: return "indirect";
  }
  return {};
}

const PlaneTraits& plane_traits(PlaneKind kind) { return kTraits[static_cast<std::size_t>(kind)]; }

PlaneId component_plane(Component component) {
  switch (component.kind) {
    case ComponentKind::kVisibility: return {PlaneKind::kVisibility, component};
    case ComponentKind::kGlossy: return {PlaneKind::kGlossy, {}};
    case ComponentKind::kIndirect: return {PlaneKind::kIndirect, {}};
  }
  return {};
}

std::string plane_name(PlaneId id) {
  const PlaneTraits& traits = plane_traits(id.kind);
  std::string name(traits.name);
  const auto hole = name.find('%');
  if (traits.per_light) name.replace(hole, 1, std::to_string(id.component.light));
  if (traits.per_component) name.replace(hole, 1, component_name(id.component));
  return name;
}

std::optional<PlaneId> plane_from_name(std::string_view name) {
  for (const PlaneTraits& traits : kTraits)
    if (const auto id = match(traits, name, "")) return id;
  return std::nullopt;
}

std::string channel_name(PlaneId id, int channel) {
  const auto& channels = plane_traits(id.kind).channels;
  return plane_name(id) + std::string(channels[static_cast<std::size_t>(channel)]);
}

std::optional<ChannelRef> channel_from_name(std::string_view name) {
  for (const PlaneTraits& traits : kTraits)
    for (std::size_t c = 0; c < traits.channels.size(); ++c)
      if (const auto id = match(traits, name, traits.channels[c]))
        return ChannelRef{*id, static_cast<int>(c)};
  return std::nullopt;
}

}  // namespace holdfast
