#pragma once

#include <string>
#include <vector>

#include "core/denoiser/denoiser.h"

namespace holdfast::cli {

/// A few successive frames in memory, as long a stream as wanted: they are played forwards and
/// backwards in turn, so that motion never jumps. Where nothing moves they are played in a circle
/// of odd length, so that no even number of frames meets the same noise again and again.
class BenchFrames {
 public:
  /// Renders `scene` (a built-in scene or a scene JSON file) at width x height, or reads the first
  /// frames of a sequence if `scene` is a folder; then its own size counts. Holds four of them, or
  /// more if `length`, of the stream, is longer and memory allows. Throws InputError.
  BenchFrames(const std::string& scene, int width, int height, int length = 0);

  /// Drops the planes of all components but these kinds ("visibility", "glossy", "indirect").
  /// Throws InputError for another name, and for one that no frame brings.
  void keep(const std::vector<std::string>& kinds);

  /// Drops all planes but guides without material, and one signal of three channels: indirect light
  /// without directions, else reflections without hits. Throws InputError if there is neither.
  void keep_one_signal();

  /// The frame to filter as the `step`-th, step = 0, 1, ...; valid until the next call.
  const Frame& at(int step);

  /// Size, lights and planes of the frames; recipe and preset are the defaults.
  const DenoiserConfig& config() const { return config_; }

 private:
  void read(const std::string& dir, int length);
  void render(const std::string& scene, int width, int height, int length);
  template <class Wanted>
  void drop_unless(const Wanted& wanted);
  bool has(PlaneKind kind) const;

  DenoiserConfig config_;
  std::vector<Frame> frames_;
  bool moves_ = false;
};

}  // namespace holdfast::cli
