#include "core/denoiser/take_over.h"

#include <algorithm>

#include "core/frame/error.h"
#include "core/history/resample.h"

namespace holdfast {

void check_same_scene(const DenoiserConfig& config, const DenoiserConfig& before) {
  const auto same = [](const Light& a, const Light& b) {
    return a.id == b.id && a.shape == b.shape && a.width == b.width && a.height == b.height &&
           a.radius == b.radius && a.radiance == b.radiance;
  };
  if (config.planes != before.planes ||
      !std::equal(config.lights.begin(), config.lights.end(), before.lights.begin(),
                  before.lights.end(), same))
    throw InputError("lights and planes", "must be those of the denoiser before", "others");
}

void take_over(const KeptParts& kept, const TakingParts& taking) {
  resample_guides(kept.guides, taking.guides);
  const auto pixels = [](const Guides& guides) {
    return static_cast<float>(guides.view.width) * static_cast<float>(guides.view.height);
  };
  const float pixel_share = std::min(1.0f, pixels(kept.guides) / pixels(taking.guides));
  // Squared: ours, tuned on fence, whose thin shadows a coarser history lacks, and glossy-floor.
  const float share = pixel_share * pixel_share;
  Guides half_before, half_after;
  if (kept.plan.half.any) half_before = kept.half.last_guides();
  if (taking.plan.half.any) {
    taking.half.remember(taking.guides);
    half_after = taking.half.last_guides();
  }
  for (std::size_t k = 0; k < taking.filters.size(); ++k) {
    const bool was_half = kept.plan.components[k].half, is_half = taking.plan.components[k].half;
    const ComponentHistory from = kept.filters[k].kept();
    const Guides& guides = is_half ? half_after : taking.guides;
    ComponentHistory to(guides.view.width, guides.view.height, from.channels, taking.plan.extras());
    resample_history(was_half ? half_before : kept.guides, guides, share, from, to);
    taking.filters[k].keep(to);
  }
}

}  // namespace holdfast
