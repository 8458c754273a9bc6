#include "core/denoiser/composite.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/denoiser/frame_input.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// One product of the sum: factor (or 1) times filtered signal (or 1).
struct Term {
  const Plane* factor;
  const Plane* signal;
  bool on_sky;
};

std::vector<Term> terms_of(std::span<const PlaneId> signals, const PlaneSet& input,
                           const PlaneSet& shaded, const PlaneSet& results) {
  std::vector<Term> terms;
  for (const PlaneId id : signals) {
    const Plane* signal = &results.at(id);
    if (id.kind == PlaneKind::kVisibility) {
      const auto unshadowed = PlaneId::of_light(PlaneKind::kUnshadowed, id.component.light);
      const Plane* factor = input.find(unshadowed);
      if (factor == nullptr) factor = shaded.find(unshadowed);
      if (factor != nullptr) terms.push_back({factor, signal, false});
    } else {
      const bool glossy = id.kind == PlaneKind::kGlossy;
      terms.push_back(
          {input.find({glossy ? PlaneKind::kSpecular : PlaneKind::kAlbedo, {}}), signal, false});
    }
  }
  if (const Plane* emission = input.find({PlaneKind::kEmission, {}}))
    terms.push_back({emission, nullptr, true});
  return terms;
}

float usable_factor(float v) {
  return std::isfinite(v) ? std::clamp(v, -kLargestRadiance, kLargestRadiance) : 0.0f;
}

/// Adds one term to a row of the sum.
void add_term(const Term& term, int channel, int y, const float* depth, int width, float* out) {
  const float* factor = term.factor ? term.factor->channel(channel).row(y) : nullptr;
  const float* signal = nullptr;
  if (term.signal) signal = term.signal->channel(term.signal->channels() == 1 ? 0 : channel).row(y);
  for (int x = 0; x < width; ++x) {
    if (!term.on_sky && !(depth[x] > 0.0f)) continue;
    const float f = factor ? usable_factor(factor[x]) : 1.0f;
    out[x] += signal ? f * signal[x] : f;
  }
}

}  // namespace

std::uint64_t compose(const Guides& guides, std::span<const PlaneId> signals, const PlaneSet& input,
                      const PlaneSet& shaded, PlaneSet& results) {
  const int width = guides.view.width;
  Plane& out = results.add({PlaneKind::kComposite, {}}, width, guides.view.height);
  const std::vector<Term> terms = terms_of(signals, input, shaded, results);
  std::atomic<std::uint64_t> non_finite{0};
  for_each_row(guides.view.height, [&](int y) {
    std::uint64_t bad = 0;
    for (int c = 0; c < 3; ++c) {
      float* row = out.channel(c).row(y);
      std::fill_n(row, width, 0.0f);
      for (const Term& term : terms) add_term(term, c, y, guides.depth().row(y), width, row);
      for (int x = 0; x < width; ++x) bad += std::isfinite(row[x]) ? 0 : 1;
    }
    if (bad > 0) non_finite += bad;
  });
  return non_finite;
}

}  // namespace holdfast
