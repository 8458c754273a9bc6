#include "core/denoiser/rest.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <tuple>
#include <utility>

#include "core/history/unlit.h"
#include "core/kernels/parallel.h"
#include "core/spatial/half_grid.h"

namespace holdfast {
namespace {

template <class T>
bool same_row(const Channels<T>& a, const Channels<T>& b, int y) {
  for (int c = 0; c < a.count(); ++c)
    if (std::memcmp(a[c].row(y), b[c].row(y), sizeof(T) * static_cast<std::size_t>(a.width())) != 0)
      return false;
  return true;
}

/// Whether `holds(y)` for all rows; rows are left out once one does not.
template <class Holds>
bool all_rows(int height, const Holds& holds) {
  std::atomic<bool> all{true};
  for_each_row(height, [&](int y) {
    if (all.load(std::memory_order_relaxed) && !holds(y)) all = false;
  });
  return all;
}

/// The client's own motion vectors say that no surface moves.
bool is_still(const Plane& motion, const Guides& guides) {
  return all_rows(motion.height(), [&](int y) {
    const float *dx = motion.channel(0).row(y), *dy = motion.channel(1).row(y);
    const float* depth = guides.depth().row(y);
    int moving = 0;
    for (int x = 0; x < motion.width(); ++x)
      moving += depth[x] > 0.0f && !(dx[x] == 0.0f && dy[x] == 0.0f) ? 1 : 0;
    return moving == 0;
  });
}

/// The light reaches the surfaces that have samples, and no others: where it does for the first
/// time there is no history.
bool is_lit_as_before(const Plane& unshadowed, const RestSignal& signal) {
  return all_rows(unshadowed.height(), [&](int y) {
    const float *r = unshadowed.channel(0).row(y), *g = unshadowed.channel(1).row(y),
                *b = unshadowed.channel(2).row(y), *depth = signal.guides.depth().row(y),
                *samples = signal.history[signal.channels].row(y);
    int differing = 0;
    for (int x = 0; x < unshadowed.width(); ++x) {
      const bool unlit = r[x] <= 0.0f && g[x] <= 0.0f && b[x] <= 0.0f;
      differing += depth[x] > 0.0f && unlit == (samples[x] > 0.0f) ? 1 : 0;
    }
    return differing == 0;
  });
}

/// Rule for changes of light, and cap of the samples.
std::pair<LightChangeRule, float> rules_of(const Recipe& recipe, ComponentKind kind) {
  const auto of = [](const auto& blend) { return std::pair(blend.change, blend.most_samples); };
  switch (kind) {
    case ComponentKind::kVisibility: return of(recipe.visibility_blend);
    case ComponentKind::kGlossy: return of(recipe.glossy_blend);
    case ComponentKind::kIndirect: return of(recipe.indirect_blend);
  }
  return {};
}

Component component_of(PlaneId id) {
  switch (id.kind) {
    case PlaneKind::kGlossy: return {ComponentKind::kGlossy, 0};
    case PlaneKind::kIndirect: return {ComponentKind::kIndirect, 0};
    default: return id.component;
  }
}

}  // namespace

bool same_guides(const Guides& a, const Guides& b) {
  return all_rows(a.depth_normal.height(), [&](int y) {
    return same_row(a.depth_normal, b.depth_normal, y) && same_row(a.id, b.id, y) &&
           same_row(a.roughness, b.roughness, y);
  });
}

RestTurns::RestTurns(const DenoiserConfig& config, const Plan& plan) : turns_(plan.rest_turns) {
  if (turns_ <= 1) return;
  const std::vector<PlaneId> results = result_planes(config);
  for (const Plan::Entry& entry : plan.components) {
    Member member;
    member.turn = entry.turn;
    std::tie(member.rule, member.most_samples) = rules_of(plan.recipe, entry.component.kind);
    member.signal = component_plane(entry.component);
    member.check = RestCheck(entry.half ? half_size(config.width) : config.width,
                             entry.half ? half_size(config.height) : config.height);
    for (const PlaneId id : results)
      if (id.kind != PlaneKind::kComposite && component_of(id) == entry.component)
        member.kept.emplace_back(id, config.width, config.height);
    members_.push_back(std::move(member));
  }
}

void RestTurns::begin_frame(const Frame& frame, const Guides& now, const Guides& before,
                            const SceneMotion& scene, bool has_past) {
  if (turns_ <= 1) return;
  const Plane* motion = frame.planes.find({PlaneKind::kMotion, {}});
  at_rest_ = has_past && scene.at_rest() && frame.camera.jitter_px == jitter_px_ &&
             same_guides(now, before) && (motion == nullptr || is_still(*motion, now));
  jitter_px_ = frame.camera.jitter_px;
  ++frames_;
  if (at_rest_) return;
  for (Member& member : members_) {
    member.settled = 0;
    member.is_kept = member.changes = false;
  }
}

bool RestTurns::watches(std::size_t k) const {
  return turns_ > 1 && at_rest_ && members_[k].settled >= kSettling - kLearning;
}

bool RestTurns::may_pass(std::size_t k) const {
  if (!at_rest_ || turns_ <= 1) return false;
  const bool due =
      frames_ % static_cast<std::uint64_t>(turns_) == static_cast<std::uint64_t>(members_[k].turn);
  return members_[k].is_kept && !due;
}

bool RestTurns::holds(std::size_t k, const RestSignal& signal, const Plane* unshadowed) {
  Member& member = members_[k];
  if (member.settled == kSettling - kLearning) member.check.restart();
  const RestFinding found = member.check.look(signal, member.rule);
  const bool learning = member.settled < kSettling;  // all that is found may be noise
  member.changes = (found != RestFinding::kSame && !learning) ||
                   (unshadowed != nullptr && !is_lit_as_before(*unshadowed, signal));
  return !member.changes;
}

void RestTurns::repeat(std::size_t k, const Guides& guides, const Channels<float>& noisy,
                       const Plane* unshadowed, PlaneSet& results) const {
  for (const Plane& kept : members_[k].kept) {
    Plane& out = results.add(kept.id(), kept.width(), kept.height());
    const bool shown = kept.id() == members_[k].signal;
    for_each_row(kept.height(), [&](int y) {
      const float* depth = guides.depth().row(y);
      int beyond = 0;
      for (int x = 0; shown && x < kept.width(); ++x) beyond += depth[x] > 0.0f ? 0 : 1;
      for (int c = 0; c < kept.channels(); ++c) {
        float* to = out.channel(c).row(y);
        std::copy_n(kept.channel(c).row(y), kept.width(), to);
        if (beyond == 0) continue;
        const float* sent = noisy[c].row(y);
        for (int x = 0; x < kept.width(); ++x) to[x] = depth[x] > 0.0f ? to[x] : sent[x];
      }
    });
    if (shown && unshadowed != nullptr) pass_unlit(*unshadowed, noisy[0], out.channel(0));
  }
}

void RestTurns::filtered(std::size_t k, const ComponentFilter& filter, const PlaneSet& results) {
  if (turns_ <= 1) return;
  Member& member = members_[k];
  const bool unchanged = at_rest_ && !member.changes && !(filter.changed_share() > kLeastChange);
  member.settled = unchanged ? std::min(member.settled + 1, kSettling) : 0;
  member.changes = false;
  const bool settled =
      member.settled == kSettling &&
      filter.mean_known_frames() >= static_cast<double>(kFullShare * member.most_samples);
  member.is_kept = settled;
  if (!settled) return;
  for (Plane& kept : member.kept) {
    const Plane& result = results.at(kept.id());
    for_each_row(kept.height(), [&](int y) {
      for (int c = 0; c < kept.channels(); ++c)
        std::copy_n(result.channel(c).row(y), kept.width(), kept.channel(c).row(y));
    });
  }
}

std::size_t RestTurns::kept_bytes(std::size_t k) const {
  std::size_t sum = 0;
  for (const Plane& kept : members_[k].kept) sum += kept.bytes();
  return sum;
}

std::size_t RestTurns::bytes() const {
  std::size_t sum = 0;
  for (std::size_t k = 0; k < members_.size(); ++k) sum += kept_bytes(k);
  return sum;
}

}  // namespace holdfast
