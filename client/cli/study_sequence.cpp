#include "client/cli/study_sequence.h"

#include <filesystem>
#include <fstream>

#include "client/cli/json_file.h"
#include "client/scenes/load.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

namespace fs = std::filesystem;

fs::path second_folder(const RenderOptions& render) { return render.out.parent_path() / "second"; }

/// Everything that the images depend on.
nlohmann::ordered_json settings_json(const RenderOptions& render) {
  const scenes::RenderSettings& settings = render.settings;
  return {{"scene", render.scene},
          {"first", settings.first_frame},
          {"frames", render.frames},
          {"width", settings.width},
          {"height", settings.height},
          {"spp", settings.spp},
          {"reference_spp", settings.reference_spp},
          {"reference_every", render.reference_every},
          {"reference_pairs", render.reference_pairs},
          {"seed", settings.seed},
          {"speed", settings.speed}};
}

void check_settings(const RenderOptions& render, const fs::path& record) {
  std::ifstream stream(record);
  if (!stream) return;
  const auto found = nlohmann::ordered_json::parse(stream, nullptr, false);
  const auto wanted = settings_json(render);
  for (const auto& [key, value] : wanted.items())
    if (!found.is_object() || !found.contains(key) || found[key] != value)
      throw InputError("sequence " + render.out.string() + ", " + key,
                       "must be " + value.dump() + " to be reused",
                       found.is_object() && found.contains(key) ? found[key].dump() : "not noted");
}

}  // namespace

void provide_sequence(const RenderOptions& render, bool reuse) {
  const fs::path record = render.out.parent_path() / "render.json";
  if (reuse && fs::exists(render.out / "sequence.json")) {
    check_settings(render, record);
    return;
  }
  fs::remove_all(second_folder(render));
  render_sequence(render);
  write_json_file(record.string(), settings_json(render));
}

PlaneSet second_reference(const RenderOptions& render, std::int64_t frame) {
  const fs::path file = sequence_file(second_folder(render), "reference", frame);
  if (fs::exists(file)) return read_exr(file);
  scenes::RenderSettings settings = render.settings;
  ++settings.seed;
  scenes::Renderer renderer(scenes::load_scene(render.scene), settings);
  fs::create_directories(file.parent_path());
  write_exr(file, renderer.reference(frame));
  return read_exr(file);
}

}  // namespace holdfast::cli
