#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/history/accumulate.h"
#include "core/history/expected_error.h"
#include "core/spatial/adaptive_filter.h"

namespace holdfast {

/// Which histories a visibility may follow. Glossy and indirect follow the surface under all but
/// kNone.
enum class HistoryVectors {
  kNone,         ///< no history at all
  kSurface,      ///< the surface's motion vector
  kPaperShadow,  ///< TRMV's shadow vector where there is one, else the surface's
  kCandidates,   ///< shadow and surface vectors, chosen and weighed by expected error
};

/// A recipe: a choice of parts. Data, not code; all recipes run through the same passes.
struct Recipe {
  std::string name;
  HistoryVectors vectors = HistoryVectors::kSurface;
  AccumulationRule accumulation;  ///< unless vectors is kCandidates
  int gradient_levels = 0;        ///< of the filter of gradient samples, which say where to replace
                                  ///< history sooner; 0: does not use them
  ExpectedErrorRule visibility_blend;  ///< if vectors is kCandidates
  ExpectedErrorRule radiance_blend;
  AdaptiveFilterSettings visibility_filter;  ///< unless svgf_filter
  AdaptiveFilterSettings radiance_filter;
  bool svgf_filter = false;  ///< SVGF's own spatial filter, first level fed back into history
  int svgf_levels = 5;       // SVGF sec. 4.4
};

/// All recipes, in the order of the documentation.
const std::vector<Recipe>& all_recipes();

/// The recipe of that name. Throws InputError listing the names if there is none.
const Recipe& find_recipe(std::string_view name);

}  // namespace holdfast
