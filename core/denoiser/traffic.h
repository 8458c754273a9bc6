#pragma once

#include "core/denoiser/recipe.h"

/// How many images of one float the passes of a component's stages read and write, each image once
/// a pass and if no tile rests. For `StageTimer`; `channels` is 1 or 3.
namespace holdfast {

/// Images that a filter pass over `channels` signals touches: the guides, signals and spread, with
/// or without edge-stopping luminance and footprint.
inline int pass_traffic(int channels, bool luminance, bool footprint) {
  return 4 + 2 * channels + 2 + (luminance ? 2 : 0) + (footprint ? 3 : 0);
}

/// Luminance and its square, the effect's field, activity, two window passes, the final means.
inline int statistics_traffic(int channels, bool footprint) {
  return channels + 2 + 3 + (footprint ? 12 : 0) +
         2 * pass_traffic(footprint ? 7 : 2, false, false) + (footprint ? 10 : 3);
}

/// Planes taken in; and where the frame before is unpacked and this one packed, that.
inline int guides_traffic(bool packed) { return 10 + (packed ? 2 * (5 + 3) : 0); }

/// Floats, and the same packed: about a third of that.
inline int packing_traffic(int images) { return images + (images + 2) / 3; }

/// Directions, guides, sample twice; cones gathered and updated; their passes.
inline int cones_traffic(const Recipe& recipe) {
  const bool colour = recipe.indirect_basis == RadianceBasis::kConesColour;
  const int passes = colour ? 3 : 2, channels = colour ? 8 : 7;
  return 3 + 8 + 6 + passes * (2 * channels + pass_traffic(channels, false, false));
}

/// Both frames' guides and ids, blockers, the field's means; taps, motion and trust.
inline int vectors_traffic() { return 5 + 5 + 2 + 3 + 5 + 3; }

/// By expected error: candidates, activity, two window passes each, choice. Else taps, histories,
/// frame.
inline int blend_traffic(int channels, bool candidates, bool follows_effect) {
  if (!candidates) return 3 * channels + 8;
  if (channels == 1) return 19 + 15 + 1 + 2 + 2 * pass_traffic(2, false, false);
  return (follows_effect ? 2 : 1) * (5 + 3 + 4 + 8 + 2 * pass_traffic(4, false, true) + 8) + 8;
}

/// Activity, luminance and its tolerance, narrowed footprint, levels; or SVGF's own filter.
inline int filter_traffic(int channels, const Recipe& recipe, bool footprint) {
  if (recipe.svgf_filter)
    return 5 + recipe.svgf_levels * (channels + 3 + pass_traffic(channels, true, false)) +
           2 * channels;
  const int levels =
      channels == 1 ? recipe.visibility_filter.levels : recipe.radiance_filter.levels;
  return 1 + channels + (channels == 3 ? 4 : 0) + 2 * pass_traffic(1, false, footprint) + 4 +
         (footprint ? pass_traffic(1, false, false) + 7 : 0) +
         levels * pass_traffic(channels, true, footprint);
}

}  // namespace holdfast
