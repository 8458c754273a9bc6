#pragma once

#include <vector>

#include "core/denoiser/component_filter.h"
#include "core/denoiser/plan.h"
#include "core/frame/frame.h"
#include "core/frame/scene_motion.h"
#include "core/history/rest_check.h"

namespace holdfast {

/// Lets components at rest take turns. While nothing moves and guides stay what they are to the
/// last bit, a component whose history has been at its cap for a while is filtered in every
/// `rest_turns`-th frame only: more frames would not lower its error. In the frames between, its
/// input is held against its history by tiles, and unless light has changed the result of its last
/// turn is returned once more. Turns are staggered, so that every frame does about as much.
/// Anything that moves, a cut, other guides, a reset or a change of preset ends the rest in that
/// very frame.
class RestTurns {
 public:
  /// Frames at rest, without a change of light, before a component takes turns. A history counts 64
  /// samples at most, at which it has twice the variance of a mean that has gone on for ever (1/64
  /// to 1/127 of a sample's); after 128 frames more it has 1.02 times that. Ours.
  static constexpr int kSettling = 192;
  /// Of these, the last ones in which it is learnt how much light seems to change by noise.
  static constexpr int kLearning = 64;
  /// Share of the tiles with changed light that ends a rest, or puts it off, if a filter with
  /// sharper eyes than ours has noticed it: in large images it takes noise for a change in a few.
  static constexpr double kLeastChange = 0.01;
  /// Of its cap, what a history must count on average: a shadow of thin things keeps some less.
  static constexpr float kFullShare = 0.9f;

  RestTurns() = default;
  RestTurns(const DenoiserConfig& config, const Plan& plan);

  /// Looks whether the scene rests: before any component of a frame. `has_past`: there is a frame
  /// before, whose guides `before` are.
  void begin_frame(const Frame& frame, const Guides& now, const Guides& before,
                   const SceneMotion& scene, bool has_past);

  /// Whether component `k` of the plan is to be passed over, if its light is still the same.
  bool may_pass(std::size_t k) const;
  /// Whether its light is to be looked at.
  bool watches(std::size_t k) const;
  /// Whether its light is still the same. `signal`: at the component's resolution; `unshadowed`: of
  /// a visibility, may be null.
  bool holds(std::size_t k, const RestSignal& signal, const Plane* unshadowed);
  /// Fills the planes of component `k` in `results` as in its last turn; pixels without surface, or
  /// unlit, show `noisy`, of the frame's size.
  void repeat(std::size_t k, const Guides& guides, const Channels<float>& noisy,
              const Plane* unshadowed, PlaneSet& results) const;
  /// Component `k` was filtered into `results`.
  void filtered(std::size_t k, const ComponentFilter& filter, const PlaneSet& results);

  /// Images of one float that a component of so many channels that is passed over reads and writes.
  static int traffic(int channels) { return 2 + 2 * channels + 1 + 3 * channels; }
  std::size_t bytes() const;
  /// Bytes of the results of component `k` that are kept.
  std::size_t kept_bytes(std::size_t k) const;

 private:
  struct Member {
    int turn = 0;
    LightChangeRule rule;
    float most_samples = 0;
    PlaneId signal;
    RestCheck check;
    std::vector<Plane> kept;  ///< result planes of its last turn
    int settled = 0;          ///< frames at rest in which it was filtered without a change
    bool is_kept = false;     ///< `kept` is of a turn in this rest
    bool changes = false;     ///< its light does, by the last look
  };

  int turns_ = 1;  ///< 1: no component ever rests
  std::vector<Member> members_;
  glm::dvec2 jitter_px_{0};
  bool at_rest_ = false;
  std::uint64_t frames_ = 0;
};

/// Whether both hold the same bits, padding apart.
bool same_guides(const Guides& a, const Guides& b);

}  // namespace holdfast
