#include "client/measure/deviation.h"

#include <algorithm>
#include <cmath>

#include "client/measure/judged.h"

namespace holdfast::measure {

void DeviationMeter::add(const Plane& result, const Plane& wanted, const Mask& surface) {
  const Measure measure = measure_of(wanted.id().kind);
  const Image a = judged_image(clean_image(result).image, measure);
  const Image b = judged_image(clean_image(wanted).image, measure);
  for (int c = 0; c < a.channels; ++c)
    for (std::size_t i = 0; i < surface.size(); ++i) {
      if (surface[i] == 0) continue;
      const double d =
          std::abs(static_cast<double>(a.channel(c)[i]) - static_cast<double>(b.channel(c)[i]));
      squares_ += d * d;
      largest_ = std::max(largest_, d);
      ++values_;
    }
}

double DeviationMeter::typical() const {
  return std::sqrt(squares_ / static_cast<double>(values_));
}

}  // namespace holdfast::measure
