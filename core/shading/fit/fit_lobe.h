#pragma once

#include <array>

#include <glm/glm.hpp>

#include "core/shading/fit/lobe_samples.h"

namespace holdfast::fit {

/// Parameters of a linear transform of the clamped cosine, on the lobe's own scale alpha, so that
/// neighbouring cells have similar ones: with (p0, p1, p2, p3),
///   M = R turn(alpha p3) U,   U = [ alpha e^p0    0       alpha p2 ]
///                                 [    0     alpha e^p1      0     ]
///                                 [    0          0          1     ]
/// R turns the normal to the mirror direction and turn(x) rotates by x in the plane of incidence.
/// Every M of a lobe with that plane of symmetry can be written so, up to a factor.
using Parameters = std::array<double, 4>;

/// The matrix turn(alpha p3) U.
glm::dmat3 mirror_from_cosine(const Parameters& p, double alpha);

struct Fit {
  Parameters parameters{};
  double misfit = 1e300;  ///< cross-entropy, nats
};

/// Fits the parameters to the lobe, from `start`; `symmetric` for a view along the normal.
///
/// Minimises the cross-entropy -integral lobe log(ltc) over the lobe's points, both normalised over
/// the upper hemisphere: the transformed cosine under which rays of the lobe are most likely.
/// Deterministic. Heitz et al. (SIGGRAPH 2016) minimise a power of the difference and leave what
/// falls below the horizon; with the same look-up, over random rectangles, the square left 1.2
/// times the RMSE of this one and twice its largest error.
Fit fit_lobe(const LobeSamples& lobe, const Parameters& start, bool symmetric);

/// The parameters of a lobe as alpha tends to 0: an ellipse around the mirror direction, which the
/// Jacobian of reflection makes narrower by the cosine across the plane of incidence.
Parameters smooth_limit(const LobeSamples& lobe);

}  // namespace holdfast::fit
