#include "core/denoiser/composite.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "core/denoiser/frame_input.h"
#include "core/kernels/parallel.h"
#include "core/kernels/variants.h"

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

/// Adds one term to a row of the sum. Null factor or signal: 1.
struct TermRow {
  const float *factor, *signal, *depth;
  bool on_sky;
  int width;
  float* out;
};

HOLDFAST_INLINE float usable_factor(float v) {
  const float bounded = min_of(max_of(v, -kLargestRadiance), kLargestRadiance);
  return abs_of(v) <= std::numeric_limits<float>::max() ? bounded : 0.0f;
}

constexpr int kAskedBlock = 64, kAskedAhead = 512;  // pixels

/// Has a block of pixels further on fetched: rows change from call to call, and a processor that
/// follows them by itself loses each at the end of a page. At the end of a row they are the next
/// one's.
HOLDFAST_INLINE void ask_ahead(const float* row) {
  for (int i = 0; i < kAskedBlock; i += 16) __builtin_prefetch(row + kAskedAhead + i);
}

HOLDFAST_INLINE void add_term_body(const TermRow& a) {
  for (int x0 = 0; x0 < a.width; x0 += kAskedBlock) {
    const float* __restrict factor = a.factor == nullptr ? nullptr : a.factor + x0;
    const float* __restrict signal = a.signal == nullptr ? nullptr : a.signal + x0;
    const float* __restrict depth = a.depth + x0;
    float* __restrict out = a.out + x0;
    const int count = min_of(kAskedBlock, a.width - x0);
    if (factor != nullptr) ask_ahead(factor);
    if (signal != nullptr) ask_ahead(signal);
    if (a.on_sky && signal == nullptr) {
      for (int x = 0; x < count; ++x) out[x] += usable_factor(factor[x]);
    } else if (factor == nullptr) {
      for (int x = 0; x < count; ++x) out[x] += depth[x] > 0.0f ? signal[x] : 0.0f;
    } else {
      for (int x = 0; x < count; ++x)
        out[x] += depth[x] > 0.0f ? usable_factor(factor[x]) * signal[x] : 0.0f;
    }
  }
}

struct NonFinite {
  const float* in;
  int width;
  int* count;
};

HOLDFAST_INLINE void count_non_finite_body(const NonFinite& a) {
  const float* __restrict in = a.in;
  int count = 0;
  for (int x = 0; x < a.width; ++x)
    count += abs_of(in[x]) <= std::numeric_limits<float>::max() ? 0 : 1;
  *a.count += count;
}

HOLDFAST_KERNEL(add_term, TermRow)
HOLDFAST_KERNEL(count_non_finite, NonFinite)

}  // namespace

std::uint64_t compose(const Guides& guides, std::span<const PlaneId> signals, const PlaneSet& input,
                      const PlaneSet& shaded, PlaneSet& results) {
  const int width = guides.view.width;
  Plane& out = results.add({PlaneKind::kComposite, {}}, width, guides.view.height);
  const std::vector<Term> terms = terms_of(signals, input, shaded, results);
  std::atomic<std::uint64_t> non_finite{0};
  for_each_row(guides.view.height, [&](int y) {
    int bad = 0;
    for (int c = 0; c < 3; ++c) {
      float* row = out.channel(c).row(y);
      std::fill_n(row, width, 0.0f);
      for (const Term& t : terms)
        add_term({t.factor ? t.factor->channel(c).row(y) : nullptr,
                  t.signal ? t.signal->channel(t.signal->channels() == 1 ? 0 : c).row(y) : nullptr,
                  guides.depth().row(y), t.on_sky, width, row});
      count_non_finite({row, width, &bad});
    }
    if (bad > 0) non_finite += static_cast<std::uint64_t>(bad);
  });
  return non_finite;
}

}  // namespace holdfast
