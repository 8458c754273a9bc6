#include "core/denoiser/denoiser.h"

#include <chrono>
#include <limits>

#include "core/frame/conventions.h"
#include "core/frame/error.h"

namespace holdfast {

class Denoiser::Impl {
 public:
  explicit Impl(const DenoiserConfig& c) : config(c) {}
  DenoiserConfig config;
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
};

Denoiser::Denoiser(const DenoiserConfig& config) : impl_(std::make_unique<Impl>(config)) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

FrameReport Denoiser::filter(const Frame& frame, PlaneSet& results) {
  if (frame.index <= impl_->last)
    throw InputError("frame index", "must be greater than " + std::to_string(impl_->last),
                     std::to_string(frame.index));
  for (const PlaneId id : impl_->config.planes) frame.planes.at(id);
  impl_->last = frame.index;
  for (const PlaneId id : result_planes(impl_->config)) {
    Plane& out = results.add(id, impl_->config.width, impl_->config.height);
    const Plane* in = frame.planes.find(id);
    for (int c = 0; in && c < out.channels(); ++c)
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out.channel(c).at(x, y) = in->channel(c).at(x, y);
  }
  FrameReport report;
  report.index = frame.index;
  return report;
}

void Denoiser::reset() {}
const DenoiserConfig& Denoiser::config() const { return impl_->config; }
std::size_t Denoiser::memory_bytes() const { return 0; }
std::string Denoiser::plan_text() const { return {}; }

const std::vector<std::string>& recipe_names() {
  static const std::vector<std::string> names{"spatial", "traditional", "clamp",
                                              "svgf",    "paper",       "reliable"};
  return names;
}
const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> names{"balanced"};
  return names;
}

std::vector<PlaneId> result_planes(const DenoiserConfig& config) {
  std::vector<PlaneId> out{{PlaneKind::kComposite, {}}};
  for (const PlaneId id : config.planes)
    if (id.kind == PlaneKind::kVisibility || id.kind == PlaneKind::kGlossy ||
        id.kind == PlaneKind::kIndirect)
      out.push_back(id);
  return out;
}

}  // namespace holdfast
