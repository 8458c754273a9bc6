#include "core/oracle/statistics.h"

#include <algorithm>

#include "core/motion/effect_field.h"
#include "core/oracle/filter_pass.h"

namespace holdfast::oracle {
namespace {

constexpr int kStep = 3;  // 9x9 pixels
constexpr int kField = 2;
constexpr double kLeastShare = 1e-3;  // of samples that say something, below which they fade

/// A window whose samples agree still gets a variance.
double variance_floor(bool visibility, double mean) {
  return visibility ? 1e-3 : 1e-4 * mean * mean + 1e-30;
}

}  // namespace

Statistics measure(const Surfaces& now, const Image& noisy, const Image& field) {
  Image measured(now.width, now.height, kField + field.channels());
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    measured.at(x, y, 0) = luminance_at(noisy, x, y);
    measured.at(x, y, 1) = square(measured.at(x, y, 0));
    for (int c = 0; c < field.channels(); ++c) measured.at(x, y, kField + c) = field.at(x, y, c);
  });
  const Image means = window_means(now, measured, kStep).values;
  Statistics out{Image(now.width, now.height, 1), {}, {}, {}};
  if (field) {
    out.footprint = Image(now.width, now.height, 3);
    out.valid = out.ratio = Image(now.width, now.height, 1);
  }
  for_each_pixel(now.width, now.height, [&](int x, int y) {
    const double mean = means.at(x, y, 0);
    out.variance.at(x, y) =
        std::max(means.at(x, y, 1) - mean * mean, variance_floor(noisy.channels() == 1, mean));
    if (!field) return;
    const double valid = means.at(x, y, kField + kFieldValid);
    out.valid.at(x, y) = valid;
    out.ratio.at(x, y) = means.at(x, y, kField + kFieldRatio);
    for (int c = 0; c < 3; ++c)
      out.footprint.at(x, y, c) =
          means.at(x, y, kField + kFieldPrecision + c) / std::max(valid, kLeastShare);
  });
  return out;
}

}  // namespace holdfast::oracle
