#include "client/measure/compare.h"

#include <algorithm>

#include "client/sequence/sequence.h"
#include "core/frame/error.h"
#include "core/kernels/parallel.h"

namespace holdfast::measure {
namespace {

namespace fs = std::filesystem;

struct JudgedFrame {
  std::int64_t index;
  std::size_t position;  ///< in the sequence's list of frames
};

std::vector<JudgedFrame> judged_frames(const SequenceReader& sequence,
                                       const CompareOptions& options) {
  std::vector<JudgedFrame> frames;
  const auto indices = sequence.frame_indices();
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= options.first && indices[i] <= options.last &&
        sequence.has_reference(indices[i]))
      frames.push_back({indices[i], i});
  if (frames.empty())
    throw InputError("sequence " + options.reference.string(),
                     "must have a reference for at least one frame in range", "without any");
  return frames;
}

bool is_judged_kind(PlaneKind kind) {
  return kind == PlaneKind::kComposite || kind == PlaneKind::kVisibility ||
         kind == PlaneKind::kGlossy || kind == PlaneKind::kIndirect;
}

bool contains(const std::vector<PlaneId>& planes, PlaneId plane) {
  return std::find(planes.begin(), planes.end(), plane) != planes.end();
}

std::vector<PlaneId> named_layers(const CompareOptions& options,
                                  const std::vector<PlaneId>& references) {
  std::vector<PlaneId> layers;
  for (const std::string& name : options.layers) {
    const auto plane = plane_from_name(name);
    if (!plane || !is_judged_kind(plane->kind))
      throw InputError("layer " + name,
                       "must be composite, light<k>.visibility, glossy or indirect", name);
    if (!contains(references, *plane))
      throw InputError("layer " + name,
                       "must be in the references of " + options.reference.string(), "missing");
    layers.push_back(*plane);
  }
  return layers;
}

/// The layers asked for, or those that the first reference shares with each test's first result.
std::vector<PlaneId> choose_layers(const SequenceReader& sequence, const CompareOptions& options,
                                   std::int64_t frame) {
  const auto references = exr_planes(sequence_file(options.reference, "reference", frame));
  std::vector<PlaneId> layers = named_layers(options, references);
  if (!layers.empty()) return layers;
  for (const PlaneId plane : references)
    if (is_judged_kind(plane.kind)) layers.push_back(plane);
  const ImageSize size{sequence.header().width, sequence.header().height};
  for (const fs::path& test : options.tests) {
    const auto results = exr_planes(sequence_file(test, "frame", frame), size);
    std::erase_if(layers, [&](PlaneId plane) { return !contains(results, plane); });
  }
  if (layers.empty())
    throw InputError("results in " + options.tests.front().string(),
                     "must share a layer with the references of " + options.reference.string(),
                     "without any of them");
  std::sort(layers.begin(), layers.end());
  return layers;
}

const Plane& layer_of(const PlaneSet& planes, PlaneId layer, const fs::path& file) {
  if (const Plane* plane = planes.find(layer)) return *plane;
  throw InputError("file " + file.string() + ", layer " + plane_name(layer), "must be present",
                   "missing");
}

/// The references of one frame, one for each layer.
std::vector<ReferenceLayer> read_references(const SequenceReader& sequence, JudgedFrame frame,
                                            const std::vector<PlaneId>& layers,
                                            std::vector<ReferenceTrack>& tracks) {
  const fs::path file = sequence_file(sequence.dir(), "reference", frame.index);
  const Mask surface =
      surface_mask(sequence.read_frame(frame.index).planes.at({PlaneKind::kDepth, {}}));
  const PlaneSet planes = sequence.read_reference(frame.index);
  std::vector<ReferenceLayer> out;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const CleanImage clean = clean_image(layer_of(planes, layers[i], file));
    if (clean.non_finite > 0)
      throw InputError("file " + file.string() + ", layer " + plane_name(layers[i]),
                       "must be finite",
                       "holding " + std::to_string(clean.non_finite) + " values that are not");
    out.push_back(tracks[i].next(frame.index, frame.position, clean.image, surface));
  }
  return out;
}

}  // namespace

std::vector<Comparison> compare(const CompareOptions& options) {
  if (options.tests.empty()) return {};
  const SequenceReader sequence(options.reference);
  const auto frames = judged_frames(sequence, options);
  const auto layers = choose_layers(sequence, options, frames.front().index);
  const ImageSize size{sequence.header().width, sequence.header().height};

  std::vector<ReferenceTrack> tracks;
  for (const PlaneId layer : layers) tracks.emplace_back(measure_of(layer.kind), options.flip);
  std::vector<std::vector<LayerMeter>> meters(options.tests.size());
  for (auto& test : meters) test.resize(layers.size());

  std::int64_t done = 0;
  const auto report = [&] {
    if (options.progress) options.progress(done, static_cast<std::int64_t>(frames.size()));
  };
  report();
  for (const JudgedFrame frame : frames) {
    const auto references = read_references(sequence, frame, layers, tracks);
    for_each_index(std::size_t{0}, options.tests.size(), std::size_t{1}, [&](std::size_t t) {
      const fs::path file = sequence_file(options.tests[t], "frame", frame.index);
      const PlaneSet planes = read_exr(file, size);
      for (std::size_t i = 0; i < layers.size(); ++i)
        meters[t][i].add(references[i], layer_of(planes, layers[i], file));
    });
    ++done;
    report();
  }

  std::vector<Comparison> out;
  for (const auto& test : meters) {
    Comparison& comparison = out.emplace_back();
    comparison.frames = static_cast<std::int64_t>(frames.size());
    comparison.last_frame = frames.back().index;
    for (std::size_t i = 0; i < layers.size(); ++i)
      comparison.layers.push_back(
          {plane_name(layers[i]), measure_of(layers[i].kind), test[i].image(), test[i].effect()});
  }
  return out;
}

}  // namespace holdfast::measure
