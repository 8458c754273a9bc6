#include "client/cli/study_trade.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <tbb/global_control.h>

#include "client/cli/percentiles.h"
#include "client/cli/progress.h"
#include "client/cli/study_sequence.h"
#include "client/cli/thread_time.h"
#include "client/cli/trade_points.h"
#include "client/cli/wire_trip.h"
#include "client/measure/deviation.h"
#include "client/measure/layer_meter.h"
#include "client/sequence/sequence.h"
#include "core/denoiser/plan.h"
#include "core/frame/error.h"
#include "proto/wire_profile.h"

namespace holdfast::cli {
namespace {

constexpr std::size_t kWarmUp = 2;  // frames: the first has no history, the second fills buffers

/// The frame at hand as it arrives under one wire profile.
class WiredFrames {
 public:
  explicit WiredFrames(const wire::WireProfile& profile)
      : profile_(profile), trip_(profile.input) {}

  void carry(const Frame& frame) {
    PlaneSet planes = std::move(arrived_.planes);
    arrived_ = {frame.index, frame.cut, frame.camera, frame.objects, frame.lights, {}};
    coded_bytes_ = static_cast<double>(trip_.carry(frame.planes, planes));
    arrived_.planes = std::move(planes);
  }
  const wire::WireProfile& profile() const { return profile_; }
  const Frame& arrived() const { return arrived_; }
  double coded_bytes() const { return coded_bytes_; }

 private:
  const wire::WireProfile& profile_;
  WireTrip trip_;
  Frame arrived_;
  double coded_bytes_ = 0;
};

/// One plan at work: all settings that come to it share its figures.
class Candidate {
 public:
  /// `frames`: that it is fed with, kept by reference.
  Candidate(const DenoiserConfig& config, const WiredFrames& frames)
      : denoiser_(config), frames_(frames), results_trip_(frames.profile().result) {}

  void filter(bool timed) {
    const double start = thread_ms();
    const FrameReport report = denoiser_.filter(frames_.arrived(), filtered_);
    const double ms = thread_ms() - start;
    wire_bytes_ +=
        frames_.coded_bytes() + static_cast<double>(results_trip_.carry(filtered_, results_));
    ++frames_seen_;
    if (!timed) return;
    ms_.push_back(ms);
    std::vector<measure::TradePoint::Stage> parts;
    for (const StageTime& stage : report.stages) {
      const std::size_t dot = stage.stage.rfind('.');
      const std::string name = dot == std::string::npos ? "frame" : stage.stage.substr(0, dot);
      auto part = std::find_if(parts.begin(), parts.end(),
                               [&](const auto& other) { return other.name == name; });
      if (part == parts.end()) part = parts.insert(parts.end(), {name, 0});
      part->ms += stage.thread_ms;  // of which there is one
    }
    stages_.push_back(std::move(parts));
  }

  /// `references`: of the judged layers, always in the same order.
  void judge(const std::vector<measure::ReferenceLayer>& references,
             const std::vector<PlaneId>& layers) {
    meters_.resize(layers.size());
    for (std::size_t k = 0; k < layers.size(); ++k)
      meters_[k].add(references[k], results_.at(layers[k]));
  }

  /// Of the last frame, as they left the denoiser.
  const PlaneSet& filtered() const { return filtered_; }

  void write(measure::TradePoint& point) const {
    const DenoiserConfig& config = denoiser_.config();
    point.ms = median(ms_);
    point.stages = stages_.front();
    for (std::size_t k = 0; k < point.stages.size(); ++k) {
      std::vector<double> values;
      for (const auto& frame : stages_) values.push_back(frame[k].ms);
      point.stages[k].ms = median(values);
    }
    point.bytes_per_pixel =
        static_cast<double>(denoiser_.memory_bytes()) / (1.0 * config.width * config.height);
    point.history_bytes_per_pixel =
        static_cast<double>(denoiser_.history_bytes()) / (1.0 * config.width * config.height);
    point.wire_bytes_per_pixel = wire_bytes_ / frames_seen_ / (1.0 * config.width * config.height);
    point.composite_rmse = meters_.back().image().rmse;
    double log_rmse = 0, ssim = 0, count = 0;
    for (std::size_t k = 0; k + 1 < meters_.size(); ++k)
      for (const measure::LayerErrors& errors : {meters_[k].image(), meters_[k].effect()}) {
        if (errors.judged_pixels == 0) continue;
        log_rmse += std::log(errors.rmse);
        ssim += errors.ssim;
        ++count;
      }
    point.rmse = std::exp(log_rmse / count);
    point.ssim = ssim / count;
  }

 private:
  Denoiser denoiser_;
  const WiredFrames& frames_;
  WireTrip results_trip_;
  PlaneSet filtered_, results_;  ///< here, and where they are sent
  double wire_bytes_ = 0, frames_seen_ = 0;
  std::vector<measure::LayerMeter> meters_;  ///< components, then the composite
  std::vector<double> ms_;
  std::vector<std::vector<measure::TradePoint::Stage>> stages_;
};

/// The candidates of a scene, and which of them each setting is.
class Candidates {
 public:
  explicit Candidates(const std::vector<TradeSetting>& settings) {
    for (const std::string& name : wire::profile_names())
      wired_.push_back(std::make_unique<WiredFrames>(*wire::find_profile(name)));
    std::vector<std::string> plans;
    for (const TradeSetting& setting : settings) {
      std::string plan = Plan::make(setting.config).text();
      plan.erase(plan.find("preset "), plan.find('\n', plan.find("preset ")) -
                                           plan.find("preset "));  // its name alone tells nothing
      plan += setting.point.wire;
      auto known = std::find(plans.begin(), plans.end(), plan);
      of_setting_.push_back(static_cast<std::size_t>(known - plans.begin()));
      if (known != plans.end()) continue;
      plans.push_back(std::move(plan));
      const auto wired = std::find_if(wired_.begin(), wired_.end(), [&](const auto& frames) {
        return frames->profile().name == setting.point.wire;
      });
      all_.push_back(std::make_unique<Candidate>(setting.config, **wired));
    }
  }

  void filter(const Frame& frame, bool timed) {
    for (const auto& frames : wired_) frames->carry(frame);
    for (const auto& candidate : all_) candidate->filter(timed);
  }
  void judge(const std::vector<measure::ReferenceLayer>& references,
             const std::vector<PlaneId>& layers) {
    for (const auto& candidate : all_) candidate->judge(references, layers);
  }
  const Candidate& of_setting(std::size_t k) const { return *all_[of_setting_[k]]; }

 private:
  std::vector<std::unique_ptr<WiredFrames>> wired_;
  std::vector<std::unique_ptr<Candidate>> all_;
  std::vector<std::size_t> of_setting_;
};

/// How far the presets of a recipe are from `reference`, which filters beside them.
class Deviations {
 public:
  /// `settings`: of which the first are the presets of the first recipe.
  Deviations(const std::vector<TradeSetting>& settings, const std::vector<PlaneId>& layers)
      : layers_(layers), reference_(reference_of(settings.front().config)) {
    while (presets_.size() < settings.size() &&
           settings[presets_.size()].point.recipe == settings.front().point.recipe &&
           !settings[presets_.size()].point.presets.empty())
      presets_.push_back(settings[presets_.size()].point.presets.front());
    meters_.resize(presets_.size() * layers.size());
  }

  /// After `candidates` have filtered it.
  void add(const Frame& frame, const Candidates& candidates) {
    reference_.filter(frame, wanted_);
    const measure::Mask surface = measure::surface_mask(frame.planes.at({PlaneKind::kDepth, {}}));
    auto meter = meters_.begin();
    for (std::size_t k = 0; k < presets_.size(); ++k)
      for (const PlaneId layer : layers_)
        (meter++)->add(candidates.of_setting(k).filtered().at(layer), wanted_.at(layer), surface);
  }

  std::vector<measure::TradeScene::Deviation> values() const {
    std::vector<measure::TradeScene::Deviation> out;
    auto meter = meters_.begin();
    for (const std::string& preset : presets_)
      for (const PlaneId layer : layers_) {
        out.push_back({preset, plane_name(layer), meter->typical(), meter->largest()});
        ++meter;
      }
    return out;
  }

 private:
  static DenoiserConfig reference_of(DenoiserConfig config) {
    config.preset = "reference";
    return config;
  }

  std::vector<PlaneId> layers_;
  std::vector<std::string> presets_;
  Denoiser reference_;
  PlaneSet wanted_;
  std::vector<measure::DeviationMeter> meters_;  ///< by preset, then layer
};

/// The filtered components of a scene, then the composite.
std::vector<PlaneId> layers_of(const DenoiserConfig& scene) {
  std::vector<PlaneId> layers;
  for (const PlaneId plane : scene.planes)
    if (plane.kind == PlaneKind::kVisibility || plane.kind == PlaneKind::kGlossy ||
        plane.kind == PlaneKind::kIndirect)
      layers.push_back(plane);
  layers.push_back({PlaneKind::kComposite, {}});
  return layers;
}

/// A frame's references of `layers`.
std::vector<measure::ReferenceLayer> references_of(const SequenceReader& sequence,
                                                   const Frame& frame, std::size_t position,
                                                   const std::vector<PlaneId>& layers,
                                                   std::vector<measure::ReferenceTrack>& tracks) {
  const PlaneSet planes = sequence.read_reference(frame.index);
  const measure::Mask surface = measure::surface_mask(frame.planes.at({PlaneKind::kDepth, {}}));
  std::vector<measure::ReferenceLayer> references;
  for (std::size_t k = 0; k < layers.size(); ++k)
    references.push_back(tracks[k].next(frame.index, position,
                                        measure::clean_image(planes.at(layers[k])).image, surface));
  return references;
}

DenoiserConfig config_of(const SequenceReader& sequence) {
  DenoiserConfig config;
  config.width = sequence.header().width;
  config.height = sequence.header().height;
  config.lights = sequence.header().lights;
  config.planes = sequence.planes();
  return config;
}

measure::TradeScene try_settings(const std::string& name, const SequenceReader& sequence,
                                 const StudyOptions& options, std::int64_t frames) {
  std::vector<std::int64_t> indices = sequence.frame_indices();
  if (static_cast<std::int64_t>(indices.size()) > frames)
    indices.resize(static_cast<std::size_t>(frames));
  const DenoiserConfig config = config_of(sequence);
  std::vector<TradeSetting> settings = trade_settings(config, options.recipes);
  const std::size_t unwired = settings.size();
  for (TradeSetting& setting : wire_settings(config, options.recipes.front()))
    settings.push_back(std::move(setting));
  Candidates candidates(settings);
  Progress progress("trade " + name, static_cast<std::int64_t>(indices.size()), options.quiet);
  const std::vector<PlaneId> layers = layers_of(config);
  std::vector<measure::ReferenceTrack> tracks;
  for (const PlaneId layer : layers) tracks.emplace_back(measure::measure_of(layer.kind), false);
  Deviations deviations(settings, layers);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Frame frame = sequence.read_frame(indices[i]);
    candidates.filter(frame, i >= kWarmUp);
    deviations.add(frame, candidates);
    if (sequence.has_reference(indices[i])) {
      candidates.judge(references_of(sequence, frame, i, layers, tracks), layers);
      ++judged;
    }
    progress.update(static_cast<std::int64_t>(i) + 1);
  }
  measure::TradeScene scene{name,
                            std::to_string(indices.size()) + " frames of " +
                                std::to_string(config.width) + "x" + std::to_string(config.height) +
                                ", " + std::to_string(judged) + " of them with references",
                            config.width,
                            config.height,
                            {},
                            {},
                            deviations.values()};
  for (std::size_t k = 0; k < settings.size(); ++k) {
    auto& points = k < unwired ? scene.points : scene.wire_points;
    candidates.of_setting(k).write(points.emplace_back(settings[k].point));
  }
  return scene;
}

/// Enough frames to time and to judge.
void check_frames(const std::string& name, const SequenceReader& sequence, std::int64_t frames) {
  const std::vector<std::int64_t> indices = sequence.frame_indices();
  const auto count = std::min(indices.size(), static_cast<std::size_t>(frames));
  if (count <= kWarmUp)
    throw InputError("frames of " + name, "must be at least 3", std::to_string(count));
  if (std::none_of(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(count),
                   [&](std::int64_t index) { return sequence.has_reference(index); }))
    throw InputError("frames of " + name, "must have a reference among them", "none");
}

}  // namespace

std::vector<measure::TradeScene> study_trade(const StudyOptions& options, std::int64_t frames,
                                             std::vector<StudyStep>& steps) {
  for (const std::string& recipe : options.recipes) find_recipe(recipe);
  std::vector<measure::TradeScene> scenes;
  for (RenderOptions render : options.scenes) {
    const std::string name = scene_folder(render.scene);
    render.out = options.out / name / "sequence";
    render.quiet = options.quiet;
    timed(steps, "render " + name, [&] { provide_sequence(render, options.reuse); });
    const SequenceReader sequence(render.out);
    check_frames(name, sequence, frames);
    timed(steps, "trade " + name, [&] {
      const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
      scenes.push_back(try_settings(name, sequence, options, frames));
    });
  }
  return scenes;
}

}  // namespace holdfast::cli
