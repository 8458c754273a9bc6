#pragma once

namespace holdfast::measure {

/// Three values of a pixel: linear RGB, YCxCz or Hunt-adjusted L*a*b*, as the name says.
struct Color {
  float x = 0, y = 0, z = 0;
};

/// Linear sRGB (D65) to YCxCz, the linearised L*a*b* of Andersson et al. 2020, eq. 4.
Color ycxcz_from_linear_rgb(Color rgb);
Color linear_rgb_from_ycxcz(Color ycxcz);

/// L*a*b* whose a* and b* are scaled by L*/100 (Hunt effect; sec. 4.1.2). `rgb` in [0,1].
Color hunt_lab_from_linear_rgb(Color rgb);

/// L* in [0,100] of linear-light grey in [0,1].
float lightness_of_grey(float grey);

/// HyAB: |dL| + sqrt(da^2 + db^2).
float hyab_distance(Color a, Color b);

/// Colour difference in [0,1] of a HyAB distance: raised to 0.7, the part up to 0.4 of the largest
/// distance (green to blue) mapped linearly to [0,0.95], the rest to (0.95,1] (sec. 4.1.3).
float redistributed_color_error(float hyab);

}  // namespace holdfast::measure
