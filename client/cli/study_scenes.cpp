#include "client/cli/study_scenes.h"

#include <algorithm>

namespace holdfast::cli {
namespace {

/// Samples of a reference whose error is a tenth of the best recipe's, as the study prints it.
int reference_samples(const std::string& scene) {
  if (scene == "fence" || scene == "cylinder") return 1600;
  if (scene == "occluder" || scene == "static") return 2048;
  if (scene == "cut") return 256;
  if (scene == "room") return 512;
  return 1024;
}

}  // namespace

RenderOptions quality_render(const std::string& scene, const QualitySettings& settings) {
  RenderOptions render;
  render.scene = scene;
  render.frames = settings.frames;
  render.settings.width = settings.width;
  render.settings.height = settings.height;
  render.settings.seed = settings.seed;
  render.settings.speed = settings.speed;
  const bool shadows_alone = scene == "fence" || scene == "cylinder";
  render.settings.reference_spp =
      settings.reference_spp > 0 ? settings.reference_spp : reference_samples(scene);
  if (scene == "cut") {
    render.settings.first_frame = 17;
    render.settings.speed = 1;
    render.frames = 103;
    render.reference_every = 5;
    render.reference_pairs = true;
  } else if (!shadows_alone && scene != "static") {
    render.reference_every = std::min<std::int64_t>(8, settings.frames);
    render.reference_pairs = true;
  }
  return render;
}

}  // namespace holdfast::cli
