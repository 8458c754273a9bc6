#include "core/denoiser/denoiser.h"

#include <cstdio>
#include <utility>

#include "core/denoiser/denoiser_impl.h"

namespace holdfast {
namespace {

/// Bytes that images of `part` are lent.
template <class Part>
std::size_t lent_bytes(const Part& part) {
  ImageBytes sum;
  Part::each_image(part, sum);
  return sum.lent;
}

}  // namespace

Denoiser::Denoiser(const DenoiserConfig& config, std::shared_ptr<ScratchPool> scratch)
    : impl_(std::make_unique<Impl>(config, std::move(scratch))) {}
Denoiser::Denoiser(const DenoiserConfig& config, const Denoiser& before)
    : Denoiser(config, before.impl_->pool) {
  check_same_scene(config, before.config());
  impl_->go_on_from(*before.impl_);
}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

FrameReport Denoiser::filter(const Frame& frame, PlaneSet& results) {
  return impl_->filter(frame, results);
}

void Denoiser::set_preset(const std::string& preset) { impl_->set_preset(preset); }

void Denoiser::reset() { impl_->has_past = false; }

const DenoiserConfig& Denoiser::config() const { return impl_->config; }

std::size_t Denoiser::held_bytes() const {
  std::size_t sum = impl_->image_bytes().owned + impl_->rest.bytes();
  if (impl_->oracle) sum += impl_->oracle->bytes();
  for (const ComponentFilter& filter : impl_->filters)
    sum += filter.history_bytes() + filter.cone_bytes();
  return sum;
}

std::size_t Denoiser::scratch_bytes() const { return impl_->need; }

std::size_t Denoiser::history_bytes() const {
  if (impl_->oracle) return impl_->oracle->bytes();
  if (!impl_->plan.history) return 0;
  std::size_t sum =
      impl_->guides.kept_bytes() + impl_->half.kept_guide_bytes() + impl_->rest.bytes();
  for (const ComponentFilter& filter : impl_->filters)
    sum += filter.history_bytes() + filter.cone_bytes();
  return sum;
}

std::string Denoiser::plan_text() const {
  const DenoiserConfig& config = impl_->config;
  const double pixels = static_cast<double>(config.width) * config.height;
  std::string text = impl_->plan.text();
  const auto add = [&](const std::string& what, std::size_t bytes) {
    if (bytes == 0) return;
    char number[32];
    std::snprintf(number, sizeof number, "%.1f", static_cast<double>(bytes) / pixels);
    text += what + ": " + number + " B/pixel\n";
  };
  if (impl_->plan.history)
    add("kept guides", impl_->guides.kept_bytes() + impl_->half.kept_guide_bytes());
  const std::string format = std::string(" as ") + history_name(impl_->plan.history_format);
  for (const ComponentFilter& filter : impl_->filters) {
    const std::string name = component_name(filter.component());
    add("kept of " + name + format, filter.history_bytes());
    add("kept cones of " + name + format, filter.cone_bytes());
  }
  add("kept results, while components rest", impl_->rest.bytes());
  add("all that is kept from frame to frame", history_bytes());
  add("all that is held from frame to frame", held_bytes());
  add("surface vectors, borrowed", lent_bytes(impl_->surface));
  add("images of components, borrowed", lent_bytes(impl_->scratch));
  add("all at half resolution, borrowed", lent_bytes(impl_->half));
  add("all that is borrowed for a frame", scratch_bytes());
  return text;
}

}  // namespace holdfast
