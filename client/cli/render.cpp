#include "client/cli/render.h"

#include <chrono>
#include <fstream>
#include <utility>

#include "client/cli/progress.h"
#include "client/scenes/load.h"
#include "client/scenes/scene_json.h"
#include "client/sequence/sequence.h"

namespace holdfast::cli {
namespace {

/// Seconds of work since construction or the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// Whether frame `i` of the sequence gets a reference.
bool wants_reference(const RenderOptions& options, std::int64_t i) {
  const std::int64_t every = options.reference_every, place = i % every;
  return options.reference_pairs ? place >= every - 2 : place == 0;
}

}  // namespace

RenderResult render_sequence(const RenderOptions& options) {
  scenes::RenderSettings settings = options.settings;
  const bool has_references = settings.reference_spp > 0;
  if (!has_references) settings.reference_spp = 1;
  scenes::Renderer renderer(scenes::load_scene(options.scene), settings);
  const scenes::Scene& scene = renderer.scene();
  if (!options.describe.empty()) write_text(options.describe, scenes::scene_to_json(scene));

  SequenceWriter writer(options.out, {settings.width, settings.height, scene.frame_rate,
                                      renderer.lights(), renderer.objects()});
  Progress progress("render " + scene.name, options.frames, options.quiet);
  Stopwatch watch;
  RenderResult result{scene.name};
  for (std::int64_t i = 0; i < options.frames; ++i) {
    const std::int64_t index = settings.first_frame + i;
    const Frame frame = renderer.frame(index);
    result.noisy_s += watch.lap();
    writer.write_frame(frame);
    result.write_s += watch.lap();
    if (has_references && wants_reference(options, i)) {
      const PlaneSet& reference = renderer.reference(index);
      result.reference_s += watch.lap();
      writer.write_reference(index, reference);
      result.write_s += watch.lap();
    }
    progress.update(i + 1);
  }
  writer.finish();
  progress.finish();
  return result;
}

}  // namespace holdfast::cli
