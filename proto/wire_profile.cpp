#include "proto/wire_profile.h"

#include <algorithm>

namespace holdfast::wire {
namespace {

using enum PlaneFormat;
constexpr Codec kPlain = Codec::kNone, kLz4 = Codec::kLz4, kZstd = Codec::kZstd;

/// What profiles say about planes of one kind. Noise is not compressed, since no codec finds much
/// in it, but where whole surfaces have none. Depth, from which positions are computed, and motion
/// vectors stay whole.
struct Row {
  PlaneKind kind;
  PlaneCoding balanced, compact;
};

constexpr Row kInputRows[] = {
    {PlaneKind::kDepth, {kF32, kLz4}, {kF32, kZstd}},
    {PlaneKind::kNormal, {kOctahedral16, kLz4}, {kOctahedral16, kZstd}},
    {PlaneKind::kObjectId, {kU8, kLz4}, {kU8, kZstd}},
    {PlaneKind::kRoughness, {kUnorm16, kLz4}, {kUnorm8, kZstd}},
    {PlaneKind::kAlbedo, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kSpecular, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kEmission, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kMotion, {kF32, kLz4}, {kF16, kZstd}},
    {PlaneKind::kUnshadowed, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kVisibility, {kUnorm16, kLz4}, {kUnorm8, kZstd}},
    {PlaneKind::kBlockerDistance, {kF16, kLz4}, {kF16, kZstd}},
    {PlaneKind::kBlockerId, {kU8, kLz4}, {kU8, kZstd}},
    {PlaneKind::kLightSample, {kUnorm16, kPlain}, {kUnorm16, kPlain}},
    {PlaneKind::kGlossy, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kGlossyDirection, {kOctahedral16, kLz4}, {kOctahedral16, kZstd}},
    {PlaneKind::kGlossyHitDistance, {kF16, kLz4}, {kF16, kZstd}},
    {PlaneKind::kGlossyHitId, {kU8, kLz4}, {kU8, kZstd}},
    {PlaneKind::kIndirect, {kF16, kPlain}, {kRgb9e5, kPlain}},
    {PlaneKind::kIndirectDirection, {kOctahedral16, kPlain}, {kOctahedral16, kPlain}},
    {PlaneKind::kGradient, {kF16, kPlain}, {kF16, kPlain}},
};

constexpr Row kResultRows[] = {
    {PlaneKind::kComposite, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kVisibility, {kUnorm16, kLz4}, {kUnorm8, kZstd}},
    {PlaneKind::kGlossy, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kIndirect, {kF16, kLz4}, {kRgb9e5, kZstd}},
    {PlaneKind::kDebugMotion, {kF32, kLz4}, {kF16, kZstd}},
    {PlaneKind::kDebugHistory, {kF32, kLz4}, {kF16, kZstd}},
    {PlaneKind::kDebugConfidence, {kF32, kLz4}, {kF16, kZstd}},
};

WireProfile profile(std::string_view name, PlaneCoding Row::*column) {
  WireProfile out{name, {}, {}};
  for (int i = 0; i < kPlaneKindCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    out.input[index] = out.result[index] = full_coding(static_cast<PlaneKind>(i));
  }
  if (column == nullptr) return out;
  for (const Row& row : kInputRows) out.input[static_cast<std::size_t>(row.kind)] = row.*column;
  for (const Row& row : kResultRows) out.result[static_cast<std::size_t>(row.kind)] = row.*column;
  return out;
}

const std::array<WireProfile, 3>& profiles() {
  static const std::array<WireProfile, 3> all{profile("exact", nullptr),
                                              profile("balanced", &Row::balanced),
                                              profile("compact", &Row::compact)};
  return all;
}

}  // namespace

const WireProfile* find_profile(std::string_view name) {
  const auto& all = profiles();
  const auto it =
      std::find_if(all.begin(), all.end(), [&](const auto& known) { return known.name == name; });
  return it == all.end() ? nullptr : &*it;
}

const std::vector<std::string>& profile_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const WireProfile& known : profiles()) list.emplace_back(known.name);
    return list;
  }();
  return names;
}

const WireProfile& exact_profile() { return profiles().front(); }

PlaneCoding fitting_coding(const Plane& plane,
                           const std::array<PlaneCoding, kPlaneKindCount>& codings) {
  const PlaneCoding wished = codings[static_cast<std::size_t>(plane.id().kind)];
  return {fitting_format(plane, wished.format), wished.codec};
}

}  // namespace holdfast::wire
