#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/history/accumulate.h"
#include "core/history/cone_history.h"
#include "core/history/expected_error.h"
#include "core/history/radiance_blend.h"
#include "core/spatial/adaptive_filter.h"

namespace holdfast {

/// What the visibility of a light with blocker planes follows besides its surface.
enum class ShadowVectors {
  kNone,
  kPaper,     ///< TRMV's shadow vector of the pixel's own blocker
  kBorrowed,  ///< the shadow vector of the mean blocker nearby
};

/// What a reflection with hit planes follows besides its surface.
enum class GlossyVectors { kNone, kSpecular, kStochastic, kRelative };

/// What indirect light follows where its surface was hidden.
enum class DisocclusionVectors { kNone, kDual };

/// How a component is blended with its history.
enum class Blending {
  kNoHistory,
  kExponential,    ///< an exponential mean along the effect's vector, else the surface's
  kExpectedError,  ///< candidates, weighed by their expected error
};

/// A recipe: a choice of parts. Data, not code; all recipes run through the same passes.
struct Recipe {
  std::string name;
  Blending blending = Blending::kExponential;
  ShadowVectors shadow = ShadowVectors::kNone;
  GlossyVectors glossy = GlossyVectors::kNone;
  DisocclusionVectors indirect = DisocclusionVectors::kNone;
  RadianceBasis indirect_basis = RadianceBasis::kIrradiance;  ///< where directions are sent
  ConeRule cones;                                             ///< of that basis, if of cones
  AccumulationRule accumulation;                              ///< of kExponential
  int gradient_levels = 0;  ///< of the filter of gradient samples, which say where to replace
                            ///< history sooner; 0: does not use them
  ExpectedErrorRule visibility_blend;  ///< of kExpectedError
  RadianceBlendRule glossy_blend;
  RadianceBlendRule indirect_blend;
  AdaptiveFilterSettings visibility_filter;  ///< unless svgf_filter
  AdaptiveFilterSettings radiance_filter;
  bool svgf_filter = false;  ///< SVGF's own spatial filter, first level fed back into history
  int svgf_levels = 5;       // SVGF sec. 4.4
};

/// All recipes, in the order of the documentation.
const std::vector<Recipe>& all_recipes();

/// `reliable` with one of its parts taken away, named `reliable-without-PART`: what each is worth.
const std::vector<Recipe>& ablated_recipes();

/// The recipe of that name, ablated ones included. Throws InputError listing the names if there is
/// none.
const Recipe& find_recipe(std::string_view name);

}  // namespace holdfast
