#include "core/history/accumulate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/frame/plane_size.h"
#include "core/kernels/math.h"
#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

using Colour = std::array<float, 3>;

Colour ycocg_from_rgb(const Colour& c) {
  return {0.25f * c[0] + 0.5f * c[1] + 0.25f * c[2], 0.5f * c[0] - 0.5f * c[2],
          -0.25f * c[0] + 0.5f * c[1] - 0.25f * c[2]};
}

/// Clamping each axis on its own may leave the colours that exist; those are brought back to 0.
Colour rgb_from_ycocg(const Colour& c) {
  return {std::max(c[0] + c[1] - c[2], 0.0f), std::max(c[0] + c[2], 0.0f),
          std::max(c[0] - c[1] - c[2], 0.0f)};
}

/// Reads a pixel in the space in which it is clamped.
Colour load(const Channels<float>& image, int channels, int x, int y) {
  if (channels == 1) return {image[0].at(x, y), 0, 0};
  return ycocg_from_rgb({image[0].at(x, y), image[1].at(x, y), image[2].at(x, y)});
}

/// What a 3x3 neighbourhood allows, in the space of `load`.
struct Bounds {
  Colour low{}, high{};
};

/// Calls `visit` with each colour of the 3x3 neighbourhood of (x, y) that is on a surface.
template <class Visit>
void for_each_neighbour(const Guides& guides, const Channels<float>& noisy, int channels, int x,
                        int y, const Visit& visit) {
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, guides.view.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, guides.view.width - 1); ++i)
      if (guides.depth().at(i, j) > 0.0f) visit(load(noisy, channels, i, j));
}

/// Mean +- gamma sigma of the neighbourhood.
Bounds deviation_bounds(const Guides& guides, const Channels<float>& noisy, int channels, int x,
                        int y, float gamma) {
  Colour sum{}, square_sum{};
  float n = 0;
  for_each_neighbour(guides, noisy, channels, x, y, [&](const Colour& c) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += c[k];
      square_sum[k] += c[k] * c[k];
    }
    n += 1;
  });
  Bounds out;
  for (std::size_t k = 0; k < 3; ++k) {
    const float mean = sum[k] / n;
    const float sigma = std::sqrt(std::max(square_sum[k] / n - mean * mean, 0.0f));
    out.low[k] = mean - gamma * sigma;
    out.high[k] = mean + gamma * sigma;
  }
  return out;
}

/// Least and greatest of the neighbourhood.
Bounds box_bounds(const Guides& guides, const Channels<float>& noisy, int channels, int x, int y) {
  const Colour own = load(noisy, channels, x, y);
  Bounds out{own, own};
  for_each_neighbour(guides, noisy, channels, x, y, [&](const Colour& c) {
    for (std::size_t k = 0; k < 3; ++k) {
      out.low[k] = std::min(out.low[k], c[k]);
      out.high[k] = std::max(out.high[k], c[k]);
    }
  });
  return out;
}

/// Clamps `history` to what the 3x3 neighbourhood of (x, y) allows by `rule`.
Colour clamp_to_neighbourhood(const Guides& guides, const Channels<float>& noisy, int channels,
                              int x, int y, const AccumulationRule& rule, const Colour& history) {
  const Bounds bounds = rule.rectification == Rectification::kClampBox
                            ? box_bounds(guides, noisy, channels, x, y)
                            : deviation_bounds(guides, noisy, channels, x, y, rule.clamp_gamma);
  Colour in = channels == 1 ? history : ycocg_from_rgb(history);
  for (std::size_t k = 0; k < 3; ++k) in[k] = std::clamp(in[k], bounds.low[k], bounds.high[k]);
  return channels == 1 ? in : rgb_from_ycocg(in);
}

/// Whether history found along the effect's vector (or the surface's) is clamped.
bool clamps(Rectification rectification, bool by_effect) {
  return rectification == Rectification::kClampFallback ? !by_effect
                                                        : rectification != Rectification::kNone;
}

}  // namespace

void accumulate(const Guides& guides, const Channels<float>& noisy, const HistorySources& sources,
                const AccumulationRule& rule, const ComponentHistory& before, ComponentHistory& now,
                Channels<float>* debug) {
  const int channels = now.channels;
  const float most_samples = (2.0f - rule.alpha) / rule.alpha;
  for_each_row(guides.view.height, [&](int y) {
    for (int x = 0; x < guides.view.width; ++x) {
      const bool by_effect = sources.effect != nullptr && sources.effect->taps[0].at(x, y).any();
      const bool valid =
          by_effect || (sources.surface != nullptr && sources.surface->taps[0].at(x, y).any());
      Colour history{};
      float samples = 0, trust = 0;
      Taps taps;
      if (valid) {
        taps = by_effect ? sources.effect->taps[0].at(x, y) : sources.surface->taps[0].at(x, y);
        trust = by_effect ? sources.effect->motion[kMotionTrust].at(x, y) : 1.0f;
        if (sources.antilag) trust *= 1.0f - sources.antilag.at(x / kStratum, y / kStratum);
        samples = gather(before.samples(), taps);
        for (int c = 0; c < channels; ++c)
          history[static_cast<std::size_t>(c)] = gather(before.data[c], taps);
        if (clamps(rule.rectification, by_effect))
          history = clamp_to_neighbourhood(guides, noisy, channels, x, y, rule, history);
      }
      const float base = std::max(rule.alpha, 1.0f / (samples + 1.0f));
      const float alpha = 1.0f - trust * (1.0f - base);
      for (int c = 0; c < channels; ++c)
        now.data[c].at(x, y) =
            alpha * noisy[c].at(x, y) + (1.0f - alpha) * history[static_cast<std::size_t>(c)];
      now.samples().at(x, y) = std::min(1.0f + trust * samples, most_samples);
      if (now.has_moments()) {
        const float l = channels == 1
                            ? noisy[0].at(x, y)
                            : luminance(noisy[0].at(x, y), noisy[1].at(x, y), noisy[2].at(x, y));
        float moment = l;
        for (int order = 1; order <= 2; ++order, moment *= l)
          now.moment(order).at(x, y) =
              alpha * moment + (valid ? (1.0f - alpha) * gather(before.moment(order), taps) : 0.0f);
      }
      if (debug != nullptr) {
        const Channels<float>* motion =
            by_effect ? &sources.effect->motion : (valid ? &sources.surface->motion : nullptr);
        (*debug)[kDebugX].at(x, y) = motion != nullptr ? (*motion)[0].at(x, y) : 0.0f;
        (*debug)[kDebugY].at(x, y) = motion != nullptr ? (*motion)[1].at(x, y) : 0.0f;
        (*debug)[kDebugFrames].at(x, y) = samples;
        (*debug)[kDebugTrust].at(x, y) = 1.0f - alpha;
      }
    }
  });
}

}  // namespace holdfast
