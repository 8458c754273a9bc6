#include "client/cli/study_vectors.h"

#include <span>

#include "client/cli/progress.h"
#include "client/measure/vector_sheet.h"
#include "client/scenes/builtin.h"
#include "client/scenes/renderer.h"

namespace holdfast::cli {
namespace {

using measure::ReferenceHalves;

/// One scene whose vectors are studied.
struct CaseSetup {
  std::string name;
  scenes::Scene scene;
  Component component;
  std::optional<double> roughness = std::nullopt;
  int half_spp = 36;      ///< samples of each half of a reference
  int effect_radius = 0;  ///< px; of `moving_effect`
  double speed = 1;
  std::int64_t first_frame = 12;
};

constexpr double kRoughnesses[] = {0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1};
constexpr double kFewRoughnesses[] = {0, 0.1, 0.5};

std::vector<CaseSetup> case_setups(bool quick) {
  std::vector<CaseSetup> cases;
  const std::span<const double> roughnesses =
      quick ? std::span<const double>(kFewRoughnesses) : std::span<const double>(kRoughnesses);
  for (const bool camera_moves : {false, true})
    for (const double roughness : roughnesses)
      cases.push_back({.name = camera_moves ? "moving camera" : "moving objects",
                       .scene = scenes::roughness_scene(roughness, camera_moves),
                       .component = {ComponentKind::kGlossy, 0},
                       .roughness = roughness,
                       .half_spp = roughness == 0 ? 1
                                   : quick        ? 16
                                                  : 36,
                       .effect_radius = roughness < 0.1 ? 0 : 2});
  for (const char* name : {"fence", "cylinder"})
    cases.push_back({.name = name,
                     .scene = scenes::builtin_scene(name),
                     .component = {ComponentKind::kVisibility, 0},
                     .half_spp = quick ? 64 : 400,
                     .speed = 2});
  cases.push_back({.name = "occluder",
                   .scene = scenes::builtin_scene("occluder"),
                   .component = {ComponentKind::kIndirect, 0},
                   .half_spp = quick ? 9 : 256,
                   .speed = 2});
  cases.back().scene.components = {false, false, true};
  return cases;
}

/// Renders what one case needs. References and draws have seeds of their own, so that no noise is
/// shared between frames, halves and draws.
class CaseRenderer {
 public:
  CaseRenderer(const CaseSetup& setup, const VectorStudyOptions& options)
      : setup_(setup), options_(options) {}

  std::vector<Light> lights() const { return renderer(0, 0).lights(); }

  ReferenceHalves reference(std::int64_t frame) const {
    const PlaneId id = component_plane(setup_.component);
    const auto half = [&](int h) {
      scenes::Renderer r = renderer(frame, stream(frame, h));
      Plane out(id, options_.width, options_.height);
      measure::add_share(out, r.reference(frame).at(id), 1.0f);
      return out;
    };
    return {half(0), half(1)};
  }
  /// A noisy frame; `lists_all` says whether its tables name every object and light.
  Frame frame(std::int64_t index, int draw, bool lists_all) const {
    scenes::Renderer r = renderer(lists_all ? index : index - 1, stream(index, 2 + draw));
    return r.frame(index);
  }

 private:
  std::uint64_t stream(std::int64_t frame, int part) const {
    return options_.seed * 1000003u + static_cast<std::uint64_t>(frame) * 1009u +
           static_cast<std::uint64_t>(part);
  }
  scenes::Renderer renderer(std::int64_t first_frame, std::uint64_t seed) const {
    scenes::RenderSettings settings;
    settings.width = options_.width;
    settings.height = options_.height;
    settings.reference_spp = setup_.half_spp;
    settings.seed = seed;
    settings.speed = setup_.speed;
    settings.first_frame = first_frame;
    settings.gradients = false;
    return scenes::Renderer(setup_.scene, settings);
  }

  const CaseSetup& setup_;
  const VectorStudyOptions& options_;
};

/// The taps of all vectors of a case between frame `index` - 1 and `index`, for each draw, and the
/// region that counts.
struct Followed {
  std::vector<std::vector<Channels<Taps>>> taps;
  measure::Mask region;
  Plane previous_ids, ids;
};

Plane ids_of(Frame& frame) { return std::move(*frame.planes.find({PlaneKind::kObjectId, {}})); }

Followed follow(const CaseSetup& setup, const CaseRenderer& renderer, std::int64_t index,
                int draws) {
  const auto vectors = measure::vectors_of(setup.component.kind);
  const std::vector<Light> lights = renderer.lights();
  Frame before = renderer.frame(index - 1, 0, true);
  Followed out;
  for (int draw = 0; draw < draws; ++draw) {
    Frame now = renderer.frame(index, draw, false);
    const measure::VectorTracer tracer(before, now, lights);
    auto& taps = out.taps.emplace_back();
    for (const measure::FollowedVector vector : vectors)
      taps.push_back(tracer.trace(vector, setup.component, static_cast<std::uint64_t>(draw)));
    if (draw > 0) continue;
    out.region = setup.component.kind == ComponentKind::kIndirect
                     ? tracer.hidden()
                     : measure::surface_mask(now.planes.at({PlaneKind::kDepth, {}}));
    out.ids = ids_of(now);
  }
  out.previous_ids = ids_of(before);
  return out;
}

void write_sheet(const CaseSetup& setup, const VectorStudyOptions& options,
                 const measure::FollowedPair& pair) {
  if (options.out.empty()) return;
  std::string name = component_name(setup.component) + "." + setup.name;
  if (setup.roughness) name += ".roughness-" + measure::number_text(*setup.roughness, 2);
  for (char& letter : name)
    if (letter == ' ') letter = '-';
  std::filesystem::create_directories(options.out);
  measure::write_png(options.out / (name + ".png"),
                     measure::vector_sheet(pair, setup.component.kind));
}

measure::VectorCase study_case(const CaseSetup& setup, const VectorStudyOptions& options, int pairs,
                               int draws) {
  const CaseRenderer renderer(setup, options);
  const ComponentKind kind = setup.component.kind;
  measure::VectorMeter meter(measure::measure_of(component_plane(setup.component).kind),
                             measure::vectors_of(kind).size());
  ReferenceHalves previous = renderer.reference(setup.first_frame);
  for (int i = 1; i <= pairs; ++i) {
    const std::int64_t index = setup.first_frame + i;
    ReferenceHalves now = renderer.reference(index);
    const Followed followed = follow(setup, renderer, index, draws);
    const measure::Mask effect = measure::moving_effect(
        previous, now, followed.previous_ids, followed.ids, setup.effect_radius, followed.region);
    const measure::FollowedPair pair{previous, now, followed.region, effect, followed.taps};
    meter.add(pair);
    if (i == pairs) write_sheet(setup, options, pair);
    previous = std::move(now);
  }
  return {setup.name,
          setup.component,
          setup.roughness,
          pairs,
          meter.figures(measure::Region::kImage),
          meter.figures(measure::Region::kEffect)};
}

}  // namespace

measure::VectorStudy study_vectors(const VectorStudyOptions& options,
                                   std::vector<StudyStep>& steps) {
  const int pairs = options.quick ? 1 : 3, draws = options.quick ? 2 : 8;
  measure::VectorStudy study{options.width, options.height, draws, {}};
  const auto setups = case_setups(options.quick);
  Progress progress("follow", static_cast<std::int64_t>(setups.size()), options.quiet);
  for (const CaseSetup& setup : setups) {
    const std::string step =
        setup.name +
        (setup.roughness ? " " + measure::number_text(*setup.roughness, 2) : std::string());
    timed(steps, step, [&] { study.cases.push_back(study_case(setup, options, pairs, draws)); });
    progress.update(static_cast<std::int64_t>(study.cases.size()));
  }
  return study;
}

}  // namespace holdfast::cli
