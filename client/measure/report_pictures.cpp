#include "client/measure/report_pictures.h"

#include "client/measure/noisy_composite.h"
#include "client/sequence/sequence.h"

namespace holdfast::measure {
namespace {

/// What a renderer shows without denoising.
Plane noisy_plane(Frame& frame, PlaneId layer) {
  if (layer.kind == PlaneKind::kComposite) return noisy_composite(frame);
  if (Plane* plane = frame.planes.find(layer)) return std::move(*plane);
  return Plane(layer, frame.planes.begin()->width(), frame.planes.begin()->height());
}

}  // namespace

std::int64_t pictured_frame(const ReportScene& scene) {
  return scene.results.front().comparison.last_frame;
}

std::vector<LayerPictures> scene_pictures(const ReportScene& scene) {
  const std::int64_t index = pictured_frame(scene);
  const SequenceReader sequence(scene.sequence);
  Frame frame = sequence.read_frame(index);
  const Mask surface = surface_mask(frame.planes.at({PlaneKind::kDepth, {}}));
  const PlaneSet references = sequence.read_reference(index);
  std::vector<PlaneSet> results;
  for (const ReportResult& result : scene.results)
    results.push_back(read_exr(sequence_file(result.dir, "frame", index)));

  const auto& layers = scene.results.front().comparison.layers;
  std::vector<LayerPictures> out;
  // Composite first: it needs the noisy planes that later layers take away.
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const PlaneId id = *plane_from_name(layer->name);
    const Plane& reference = references.at(id);
    LayerPictures& pictures = out.emplace_back();
    pictures.layer = layer->name;
    const auto add = [&](const std::string& name, const Plane& plane) {
      pictures.pictures.push_back({name, picture_of(plane), error_map(plane, reference, surface)});
    };
    add("noisy", noisy_plane(frame, id));
    for (std::size_t r = 0; r < results.size(); ++r) add(scene.results[r].name, results[r].at(id));
    add("reference", reference);
  }
  return out;
}

}  // namespace holdfast::measure
