#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace holdfast::server {

/// Chooses the preset of each frame of a session, so that frames keep to a budget without visible
/// pumping. Knows neither clocks nor the core: it is told what frames took.
///
///   down   as soon as kMissesAllowed + 1 of the last kJudged frames were over the budget: to the
///          best preset that should now keep to it, else to the fastest
///   up     by one preset, once that should have stayed below kClear of the budget for `patience`
///          frames on end. Patience begins with kPatience; it doubles, up to kMostPatience, when
///          the better preset misses the budget within kTrial frames, and halves again when it does
///          not
///   cost   of preset k: c_k times the median, over the last kRemembered frames, of what a frame
///          took over its c. The c are what was expected at first, corrected where a better preset
///          was tried; the correction is forgotten slowly, since what is shown changes
///
/// The first frames of a session and the one that changes the preset are not judged: they fill
/// buffers.
class PresetChooser {
 public:
  static constexpr std::size_t kJudged = 3, kMissesAllowed = 1;
  static constexpr double kClear = 0.85;
  static constexpr int kPatience = 30, kMostPatience = 64 * kPatience;
  static constexpr std::size_t kTrial = 1000;
  static constexpr std::size_t kRemembered = 9;
  static constexpr int kWarmUp = 2;         ///< first frames that are not judged
  static constexpr double kForgets = 5e-4;  ///< of a correction, each frame

  /// `expected_ms`: of a frame in each preset, fastest first, at least one, each > 0. `budget_ms`
  /// > 0. Begins with the best preset that should stay clear of the budget, else the fastest.
  PresetChooser(std::vector<double> expected_ms, double budget_ms);

  /// Index of the next frame's preset.
  std::size_t preset() const { return preset_; }
  /// A frame with that preset took `core_ms` in the core, once it had waited for `waited_ms`
  /// because of others; both count for the budget, but only the first depends on the preset.
  void measured(double core_ms, double waited_ms);

 private:
  double expected(std::size_t preset, std::size_t frames) const;
  bool missed() const;
  void go_down();
  void consider_up();
  void learn();
  void end_trial(bool kept);
  void go_to(std::size_t preset);

  const std::vector<double> given_ms_;
  std::vector<double> cost_ms_;  ///< given_ms_, corrected
  const double budget_ms_;
  std::size_t preset_ = 0;
  int unjudged_ = kWarmUp;
  int patience_ = kPatience, calm_ = 0;
  std::size_t trial_ = 0;     ///< 1 + judged frames of the better preset on trial; 0: none is
  double before_trial_ = 0;   ///< load when the trial began
  std::deque<double> loads_;  ///< core_ms over cost_ms_ of the preset, newest last
  std::deque<double> waits_;  ///< ms, likewise
  std::deque<bool> misses_;   ///< of the last frames in this preset
};

}  // namespace holdfast::server
