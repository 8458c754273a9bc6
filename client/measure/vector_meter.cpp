#include "client/measure/vector_meter.h"

#include <algorithm>
#include <cmath>

#include "client/measure/layer_meter.h"

namespace holdfast::measure {
namespace {

Image judged(const Plane& plane, Measure measure) {
  return judged_image(clean_image(plane).image, measure);
}

/// The mean of the neighbours of (x, y) within `radius` that have its id.
float mean_around(ChannelView<const float> values, ChannelView<const std::uint32_t> ids, int x,
                  int y, int radius) {
  float sum = 0, count = 0;
  for (int v = std::max(0, y - radius); v <= std::min(values.height - 1, y + radius); ++v)
    for (int u = std::max(0, x - radius); u <= std::min(values.width - 1, x + radius); ++u) {
      if (ids.at(u, v) != ids.at(x, y)) continue;
      sum += values.at(u, v);
      count += 1;
    }
  return sum / count;
}

Plane smoothed(const Plane& plane, const Plane& ids, int radius) {
  Plane out(plane.id(), plane.width(), plane.height());
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x)
        out.channel(c).at(x, y) = mean_around(plane.channel(c), ids.ids(), x, y, radius);
  return out;
}

Plane empty_like(const Plane& plane) { return Plane(plane.id(), plane.width(), plane.height()); }

Mask found_in(const Channels<Taps>& taps) {
  Mask out;
  for (int y = 0; y < taps.height(); ++y)
    for (int x = 0; x < taps.width(); ++x) out.push_back(taps[0].at(x, y).any() ? 1 : 0);
  return out;
}

void keep_common(Mask& mask, const Mask& other) {
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] && other[i] ? 1 : 0;
}

/// For each draw, where all its vectors lead somewhere.
std::vector<Mask> common_valid(const FollowedPair& pair) {
  std::vector<Mask> out;
  for (const auto& draw : pair.taps) {
    Mask mask = found_in(draw[0]);
    for (std::size_t v = 1; v < draw.size(); ++v) keep_common(mask, found_in(draw[v]));
    out.push_back(std::move(mask));
  }
  return out;
}

}  // namespace

void add_share(Plane& to, const Plane& from, float share) {
  for (int c = 0; c < to.channels(); ++c)
    for (int y = 0; y < to.height(); ++y)
      for (int x = 0; x < to.width(); ++x)
        to.channel(c).at(x, y) += share * from.channel(c).at(x, y);
}

Plane mean_of(const ReferenceHalves& halves) {
  Plane out = empty_like(halves[0]);
  for (const Plane& half : halves) add_share(out, half, 0.5f);
  return out;
}

Mask moving_effect(const ReferenceHalves& previous, const ReferenceHalves& now,
                   const Plane& previous_ids, const Plane& ids, int radius, const Mask& region) {
  const Measure measure = measure_of(now[0].id().kind);
  return effect_mask(judged(smoothed(mean_of(now), ids, radius), measure),
                     judged(smoothed(mean_of(previous), previous_ids, radius), measure), region);
}

void VectorMeter::Mean::add(const std::vector<double>& values, const Mask& mask, const Mask& also) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!mask[i] || !also[i]) continue;
    sum += values[i];
    ++count;
  }
}

double VectorMeter::Mean::root() const {
  return count > 0 ? std::sqrt(std::max(0.0, sum / static_cast<double>(count))) : std::nan("");
}

VectorMeter::VectorMeter(Measure measure, std::size_t vectors) : measure_(measure) {
  for (RegionSums& region : regions_) region.vectors.resize(vectors);
}

/// For each pixel, the mean over the channels of the product of both halves' errors.
std::vector<double> VectorMeter::product_of_errors(const ReferenceHalves& warped,
                                                   const ReferenceHalves& now) const {
  std::array<Image, 2> error;
  for (std::size_t h = 0; h < 2; ++h)
    error[h] = difference(judged(warped[h], measure_), judged(now[h], measure_));
  std::vector<double> out(error[0].pixels());
  for (int c = 0; c < error[0].channels; ++c)
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += static_cast<double>(error[0].channel(c)[i]) *
                static_cast<double>(error[1].channel(c)[i]) / error[0].channels;
  return out;
}

void VectorMeter::start_pair(const FollowedPair& pair) {
  regions_[0].mask = pair.region;
  regions_[1].mask = pair.effect;
  const Image noise = difference(judged(pair.now[0], measure_), judged(pair.now[1], measure_));
  std::vector<double> squared(noise.pixels());
  for (int c = 0; c < noise.channels; ++c)
    for (std::size_t i = 0; i < squared.size(); ++i) {
      const double value = static_cast<double>(noise.channel(c)[i]);
      squared[i] += 0.5 * value * value / noise.channels;  // both halves have the noise
    }
  for (RegionSums& region : regions_) {
    region.pixels += std::count(region.mask.begin(), region.mask.end(), 1);
    region.noise.add(squared, region.mask, region.mask);
  }
}

void VectorMeter::add_vector(const FollowedPair& pair, std::size_t v,
                             const std::vector<Mask>& all_valid) {
  const float share = 1.0f / static_cast<float>(pair.taps.size());
  ReferenceHalves mean{empty_like(pair.now[0]), empty_like(pair.now[1])};
  Mask always(pair.region.size(), 1);
  for (std::size_t d = 0; d < pair.taps.size(); ++d) {
    const Channels<Taps>&taps = pair.taps[d][v], &fallback = pair.taps[d][0];
    Warped warped[2];
    for (std::size_t h = 0; h < 2; ++h) {
      warped[h] = warp(pair.previous[h], taps[0], fallback[0]);
      add_share(mean[h], warped[h].image, share);
    }
    keep_common(always, warped[0].found);
    const auto products =
        product_of_errors({std::move(warped[0].image), std::move(warped[1].image)}, pair.now);
    const Mask own = found_in(taps);
    const std::vector<double> one_where_found(own.begin(), own.end());
    for (RegionSums& region : regions_) {
      VectorSums& sums = region.vectors[v];
      sums.valid.add(products, region.mask, all_valid[d]);
      sums.fallback.add(products, region.mask, warped[0].found);
      sums.share.add(one_where_found, region.mask, region.mask);
    }
  }
  const auto products = product_of_errors(mean, pair.now);
  for (RegionSums& region : regions_) region.vectors[v].mean.add(products, region.mask, always);
}

void VectorMeter::add(const FollowedPair& pair) {
  start_pair(pair);
  const std::vector<Mask> all_valid = common_valid(pair);
  for (std::size_t v = 0; v < regions_[0].vectors.size(); ++v) add_vector(pair, v, all_valid);
}

RegionFigures VectorMeter::figures(Region region) const {
  const RegionSums& sums = regions_[region == Region::kImage ? 0 : 1];
  RegionFigures out{sums.pixels, sums.noise.root(), {}};
  for (const VectorSums& v : sums.vectors)
    out.vectors.push_back(
        {v.valid.root(), v.fallback.root(), v.mean.root(),
         v.share.count > 0 ? v.share.sum / static_cast<double>(v.share.count) : std::nan("")});
  return out;
}

}  // namespace holdfast::measure
