#include "core/denoiser/composite.h"

#include <atomic>
#include <cmath>
#include <vector>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// One product of the sum: factor (or 1) times filtered signal (or 1).
struct Term {
  const Plane* factor;
  const Plane* signal;
  bool on_sky;
};

std::vector<Term> terms_of(const PlaneSet& input, const PlaneSet& results) {
  std::vector<Term> terms;
  for (const Plane& plane : results) {
    const std::uint32_t light = plane.id().component.light;
    switch (plane.id().kind) {
      case PlaneKind::kVisibility:
        if (const Plane* unshadowed = input.find(PlaneId::of_light(PlaneKind::kUnshadowed, light)))
          terms.push_back({unshadowed, &plane, false});
        break;
      case PlaneKind::kGlossy:
        terms.push_back({input.find({PlaneKind::kSpecular, {}}), &plane, false});
        break;
      case PlaneKind::kIndirect:
        terms.push_back({input.find({PlaneKind::kAlbedo, {}}), &plane, false});
        break;
      default: break;
    }
  }
  if (const Plane* emission = input.find({PlaneKind::kEmission, {}}))
    terms.push_back({emission, nullptr, true});
  return terms;
}

float finite_or_zero(float v) { return std::isfinite(v) ? v : 0.0f; }

}  // namespace

std::uint64_t compose(const Guides& guides, const PlaneSet& input, PlaneSet& results) {
  const int width = guides.view.width, height = guides.view.height;
  Plane& out = results.add({PlaneKind::kComposite, {}}, width, height);
  const std::vector<Term> terms = terms_of(input, results);
  std::atomic<std::uint64_t> non_finite{0};
  for_each_row(height, [&](int y) {
    std::uint64_t bad = 0;
    for (int c = 0; c < 3; ++c)
      for (int x = 0; x < width; ++x) {
        const bool surface = guides.depth().at(x, y) > 0.0f;
        float sum = 0;
        for (const Term& term : terms) {
          if (!surface && !term.on_sky) continue;
          const float factor = term.factor ? finite_or_zero(term.factor->channel(c).at(x, y)) : 1.0f;
          const float signal =
              term.signal ? term.signal->channel(term.signal->channels() == 1 ? 0 : c).at(x, y) : 1.0f;
          sum += factor * signal;
        }
        bad += std::isfinite(sum) ? 0 : 1;
        out.channel(c).at(x, y) = sum;
      }
    if (bad > 0) non_finite += bad;
  });
  return non_finite;
}

}  // namespace holdfast
