#pragma once

namespace holdfast {

/// How the fitted table is stored, shared by the program that writes it and the look-up.
///
/// Cell (i, j) belongs to perceptual roughness i / (kLtcSide - 1) and to
/// sqrt(1 - n.v) = j / (kLtcSide - 1); rows of j follow each other. A cell holds the matrix S of
/// M^-1 = S R^T (R turns the normal to the mirror direction), scaled to S_yy = 1, in a form that
/// changes slowly: S_xx, S_xz, S_zx / alpha, S_zz / alpha. Then the lobe's integrals without
/// Fresnel's term, and weighted by (1 - h.v)^5.
inline constexpr int kLtcSide = 64;
enum LtcEntry { kLtcXx, kLtcXz, kLtcZx, kLtcZz, kLtcMagnitude, kLtcFresnel, kLtcEntries };

}  // namespace holdfast
