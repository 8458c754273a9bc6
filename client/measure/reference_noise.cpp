#include "client/measure/reference_noise.h"

#include <algorithm>
#include <cmath>

#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::measure {
namespace {

std::vector<std::int64_t> referenced_frames(const SequenceReader& sequence) {
  std::vector<std::int64_t> frames = sequence.frame_indices();
  std::erase_if(frames, [&](std::int64_t i) { return !sequence.has_reference(i); });
  return frames;
}

/// A reference with the surface of its frame.
struct Reference {
  std::int64_t frame;
  PlaneSet planes;
  Mask surface;
};

Reference read(const SequenceReader& sequence, std::int64_t frame) {
  return {frame, sequence.read_reference(frame),
          surface_mask(sequence.read_frame(frame).planes.at({PlaneKind::kDepth, {}}))};
}

ReferenceNoise noise_of(const Reference* earlier, const Reference& now, const Plane& second) {
  const PlaneId layer = second.id();
  ReferenceTrack track(measure_of(layer.kind), false);
  // Positions apart: change from frame to frame is not asked for.
  if (earlier)
    track.next(earlier->frame, 0, clean_image(earlier->planes.at(layer)).image, earlier->surface);
  LayerMeter meter;
  meter.add(track.next(now.frame, 2, clean_image(now.planes.at(layer)).image, now.surface), second);
  const double share = std::sqrt(0.5);  // both references have the noise
  return {plane_name(layer), share * meter.image().rmse, share * meter.effect().rmse};
}

}  // namespace

std::int64_t last_referenced_frame(const std::filesystem::path& sequence) {
  const auto frames = referenced_frames(SequenceReader(sequence));
  if (frames.empty())
    throw InputError("sequence " + sequence.string(), "must have a reference", "without any");
  return frames.back();
}

std::vector<ReferenceNoise> reference_noise(const std::filesystem::path& sequence,
                                            std::int64_t frame, const PlaneSet& second) {
  const SequenceReader reader(sequence);
  const Reference now = read(reader, frame);
  std::optional<Reference> earlier;
  for (const std::int64_t i : referenced_frames(reader))
    if (i < frame && (!earlier || i > earlier->frame)) earlier = Reference{i, {}, {}};
  if (earlier) earlier = read(reader, earlier->frame);
  std::vector<ReferenceNoise> noise;
  for (const Plane& plane : second)
    if (now.planes.find(plane.id()))
      noise.push_back(noise_of(earlier ? &*earlier : nullptr, now, plane));
  return noise;
}

std::optional<ReferenceCheck> check_references(const ReportScene& scene, const std::string& layer,
                                               Region region) {
  const auto found =
      std::find_if(scene.reference_noise.begin(), scene.reference_noise.end(),
                   [&](const ReferenceNoise& noise) { return noise.layer == layer; });
  if (found == scene.reference_noise.end()) return {};
  ReferenceCheck check{region == Region::kImage ? found->image : found->effect, std::nan(""),
                       false};
  for (const ReportResult& result : scene.results)
    for (const Comparison::Layer& errors : result.comparison.layers)
      if (errors.name == layer)
        check.best_rmse = std::fmin(check.best_rmse, errors_of(errors, region).rmse);
  if (std::isnan(check.noise) || std::isnan(check.best_rmse)) return {};
  check.sufficient =
      std::sqrt(2.0) * check.noise < kReferenceShare * check.best_rmse || check.noise == 0;
  return check;
}

}  // namespace holdfast::measure
