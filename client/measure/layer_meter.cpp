#include "client/measure/layer_meter.h"

#include <cmath>
#include <limits>

namespace holdfast::measure {

std::vector<double> squared_difference(const Image& a, const Image& b) {
  std::vector<double> out(a.pixels());
  for (int c = 0; c < a.channels; ++c)
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double d = static_cast<double>(a.channel(c)[i]) - static_cast<double>(b.channel(c)[i]);
      out[i] += d * d;
    }
  return out;
}

Image difference(const Image& a, const Image& b) {
  Image out = a;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] -= b.values[i];
  return out;
}

ReferenceLayer ReferenceTrack::next(std::int64_t frame, std::size_t position, const Image& clean,
                                    const Mask& surface) {
  ReferenceLayer out;
  out.frame = frame;
  out.measure = measure_;
  out.judged = judged_image(clean, measure_);
  out.surface = surface;
  out.effect.resize(surface.size());
  if (!earlier_.empty()) {
    out.effect = effect_mask(out.judged, earlier_, surface);
    out.follows_previous = position == earlier_position_ + 1;
    if (out.follows_previous) {
      out.change = difference(out.judged, earlier_);
      out.change_surface = surface;
      for (std::size_t i = 0; i < surface.size(); ++i) out.change_surface[i] &= earlier_surface_[i];
    }
  }
  out.ssim = std::make_unique<SsimReference>(out.judged, surface);
  if (with_flip_) out.flip = std::make_unique<FlipReference>(clean, surface);
  earlier_ = out.judged;
  earlier_surface_ = surface;
  earlier_position_ = position;
  return out;
}

void LayerMeter::add(const ReferenceLayer& reference, const Plane& result) {
  const CleanImage clean = clean_image(result);
  Image judged = judged_image(clean.image, reference.measure);
  non_finite_ += clean.non_finite;

  Maps maps;
  maps.squared = squared_difference(reference.judged, judged);
  maps.ssim = reference.ssim->map(judged);
  if (reference.flip) maps.flip = reference.flip->map(clean.image);
  if (reference.follows_previous)
    maps.flicker = squared_difference(reference.change, difference(judged, previous_));
  accumulate(image_, reference.surface, reference, maps);
  accumulate(effect_, reference.effect, reference, maps);
  previous_ = std::move(judged);
}

void LayerMeter::accumulate(Sums& sums, const Mask& mask, const ReferenceLayer& reference,
                            const Maps& maps) {
  Mean squared;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    squared.sum += maps.squared[i];
    squared.count += reference.judged.channels;
    sums.ssim.sum += static_cast<double>(maps.ssim[i]);
    if (!maps.flip.empty()) sums.flip.sum += static_cast<double>(maps.flip[i]);
    if (!maps.flicker.empty() && reference.change_surface[i]) {
      sums.flicker.sum += maps.flicker[i];
      sums.flicker.count += reference.judged.channels;
    }
  }
  if (squared.count == 0) return;
  const std::int64_t pixels = squared.count / reference.judged.channels;
  sums.pixels += pixels;
  sums.ssim.count += pixels;
  sums.flip.count += maps.flip.empty() ? 0 : pixels;
  sums.squared.sum += squared.sum;
  sums.squared.count += squared.count;
  sums.per_frame.push_back({reference.frame, std::sqrt(squared.value())});
}

double LayerMeter::Mean::value() const {
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

LayerErrors LayerMeter::Sums::errors(std::int64_t non_finite) const {
  LayerErrors out;
  out.rmse = std::sqrt(squared.value());
  out.psnr = -20 * std::log10(out.rmse);
  out.ssim = ssim.value();
  out.flip = flip.value();
  out.flicker = std::sqrt(flicker.value());
  out.non_finite = non_finite;
  out.judged_pixels = pixels;
  out.per_frame = per_frame;
  return out;
}

}  // namespace holdfast::measure
