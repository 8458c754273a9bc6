#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "client/cli/command.h"
#include "client/cli/frame_range.h"
#include "client/cli/json_file.h"
#include "client/cli/progress.h"
#include "client/measure/debug_picture.h"
#include "client/measure/judged.h"
#include "client/measure/static_motion.h"
#include "client/sequence/sequence.h"
#include "core/frame/error.h"

namespace holdfast::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string results, sequence, out, frames, json;
  bool quiet = false;
};

/// Writes pictures and remembers their names.
class Gallery {
 public:
  explicit Gallery(fs::path dir) : dir_(std::move(dir)) { fs::create_directories(dir_); }

  void add(std::int64_t index, const std::string& name, const measure::Picture& picture) {
    fs::path file = sequence_file(dir_, "frame", index);
    file.replace_extension(name + ".png");
    write_png(file, picture);
    files_.push_back(file.filename().string());
  }
  const std::vector<std::string>& files() const { return files_; }

 private:
  fs::path dir_;
  std::vector<std::string> files_;
};

void show_debug(const fs::path& file, const Frame& frame, const measure::Mask& shown,
                Gallery& gallery) {
  const PlaneSet result = read_exr(file);
  const std::vector<Component> components = measure::debug_components(result);
  if (components.empty())
    throw InputError(file.string(), "must have debug planes, which replay --debug writes",
                     "without any");
  for (const Component component : components) {
    const std::string name = component_name(component);
    const std::string title = "frame " + std::to_string(frame.index) + " " + name;
    for (const auto& [end, picture] : measure::debug_pictures(result, component, shown, title))
      gallery.add(frame.index, name + "." + end, picture);
  }
}

void show_static(const Frame& frame, const SceneMotion& scene, Gallery& gallery) {
  const measure::StaticMotion motion = measure::static_motion(frame, scene);
  const std::string title = "frame " + std::to_string(frame.index) + " ";
  gallery.add(frame.index, "surface.motion",
              titled_motion(motion.given, motion.shown, title + "surface motion as given"));
  gallery.add(frame.index, "surface.motion-minus-static",
              titled_motion(measure::motion_difference(motion), motion.shown,
                            title + "given motion minus that of a static world"));
}

/// Frames before the wanted ones are read, too: their tables say where objects were.
void run(const Options& options) {
  const FrameRange range = frame_range(options.frames);
  const SequenceReader sequence(options.sequence);
  const SequenceHeader& header = sequence.header();
  std::vector<std::int64_t> indices = sequence.frame_indices();
  while (!indices.empty() && indices.back() > range.last) indices.pop_back();
  if (indices.empty() || !range.contains(indices.back()))
    throw InputError("--frames", "must be some of the frames of " + options.sequence,
                     "\"" + options.frames + "\"");
  Gallery gallery(options.out);
  SceneMotion scene;
  Progress progress("show", static_cast<std::int64_t>(indices.size()), options.quiet);
  std::int64_t done = 0;
  for (const std::int64_t index : indices) {
    const Frame frame = sequence.read_frame(index);
    if (frame.cut) scene.reset();
    scene.advance(frame, header.width, header.height, header.lights);
    const fs::path result = sequence_file(options.results, "frame", index);
    if (range.contains(index) && (!options.frames.empty() || fs::exists(result))) {
      const auto shown = measure::surface_mask(frame.planes.at({PlaneKind::kDepth, {}}));
      show_debug(result, frame, shown, gallery);
      show_static(frame, scene, gallery);
    }
    progress.update(++done);
  }
  progress.finish();
  if (gallery.files().empty())
    throw InputError(options.results, "must have results of frames of " + options.sequence,
                     "without");
  if (!options.json.empty()) write_json_file(options.json, {{"pictures", gallery.files()}});
  if (!options.quiet)
    std::printf("%zu pictures in %s\n", gallery.files().size(), options.out.c_str());
}

}  // namespace

void add_show(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "show", "Pictures of motion vectors, history and confidence of results with debug planes");
  command->add_option("OUT", options->results, "Results, frame.####.exr of replay --debug")
      ->required();
  command->add_option("--sequence", options->sequence, "Sequence that they were made of")
      ->required();
  command->add_option("-o,--output", options->out, "Directory of the PNG files")->required();
  command->add_option("--frames", options->frames,
                      "Frame indices A-B, both included; default: all that have results");
  command->add_option("--json", options->json, "Write the names of the pictures to this file");
  command->add_flag("--quiet", options->quiet, "No progress, no summary");
  command->callback([options] { run(*options); });
}

}  // namespace holdfast::cli
