#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"
#include "core/history/accumulate.h"
#include "core/kernels/random.h"

namespace holdfast::stability {
namespace {

constexpr int kPeriod = 32;    ///< frames after which what moves is where it was
constexpr int kSettled = 256;  ///< frames after which any history is as long as it gets
constexpr int kStillDraws = 4096, kMovingDraws = 512;  ///< of a truth

struct Sums {
  double squares = 0, found = 0, truth = 0, count = 0;
  double rmse() const { return std::sqrt(squares / count); }
};

/// Adds a frame's difference from the truth, and the energy of both.
void add(const PlaneSet& results, const PlaneSet& truth, Sums& sums) {
  for (const Plane& mean : truth)
    for (int c = 0; c < mean.channels(); ++c)
      for (int y = 0; y < mean.height(); ++y)
        for (int x = 0; x < mean.width(); ++x) {
          const double found = double{results.at(mean.id()).channel(c).at(x, y)};
          const double wanted = double{mean.channel(c).at(x, y)};
          sums.squares += (found - wanted) * (found - wanted);
          sums.found += found;
          sums.truth += wanted;
          sums.count += 1;
        }
}

World small_world(const std::string& recipe, const Histories& histories) {
  World world;
  world.recipe = recipe;
  world.history = histories.format;
  world.width = 9;
  world.height = 7;
  return world;
}

/// Camera, box and light go round and round.
World moving_world(const std::string& recipe, const Histories& histories) {
  World world = small_world(recipe, histories);
  const auto turn = [](int t) { return 2 * std::numbers::pi * (t % kPeriod) / kPeriod; };
  world.camera = [=](int t) {
    return glm::translate(glm::dmat4(1), {0.2 * std::sin(turn(t)), 0.1 * std::cos(turn(t)), 0});
  };
  world.box = [=](int t) {
    return glm::rotate(glm::translate(glm::dmat4(1), {-0.6 + 0.5 * std::cos(turn(t)), -0.2, -4}),
                       turn(t), glm::dvec3(0.2, 1, 0.4));
  };
  const auto light = world.light_place;
  world.light_place = [=](int t) {
    return glm::translate(glm::dmat4(1), {0.4 * std::sin(turn(t)), 0, 0}) * light(0);
  };
  return world;
}

/// What `kPeriod` frames that have settled are like, and the last ones; infinite errors where a
/// value was not finite.
struct Run {
  Sums early, late;
  double growth = 0;  ///< of the heap between both, bytes

  double drift() const { return late.rmse() / early.rmse(); }
  double energy() const { return std::abs(late.found / late.truth - early.found / early.truth); }
};

/// In use by the whole process; 0 where the allocator does not say, as under sanitizers.
double heap_bytes() {
  const auto of = mallinfo2();
  return static_cast<double>(of.uordblks) + static_cast<double>(of.hblkhd);
}

Run run(const World& world, int frames) {
  std::vector<PlaneSet> truths;
  for (int t = 0; t < (world.still ? 1 : kPeriod); ++t)
    truths.push_back(truth(world, t, world.still ? kStillDraws : kMovingDraws));
  Denoiser denoiser(session_of(world));
  Run out;
  PlaneSet results;
  for (int t = 0; t < frames; ++t) {
    if (denoiser.filter(render(world, t), results).non_finite_out > 0)
      return {{1, 1, 1, 1}, {HUGE_VAL, HUGE_VAL, 1, 1}, 0};
    const PlaneSet& mean = truths[static_cast<std::size_t>(t) % truths.size()];
    if (t >= kSettled - kPeriod && t < kSettled) add(results, mean, out.early);
    if (t == kSettled) out.growth = -heap_bytes();
    if (t >= frames - kPeriod) add(results, mean, out.late);
  }
  out.growth += heap_bytes();
  return out;
}

Entry at_rest(const char* name, int frames, Entry::Cost cost, const Histories& histories) {
  return {histories.name(name),
          std::to_string(frames) + " frames of a scene at rest",
          "no drift: the error at the end over that after 256 frames",
          1.2,
          [=](const std::string& recipe) {
            World world = small_world(recipe, histories);
            world.still = true;
            return run(world, frames).drift();
          },
          cost};
}

/// One session tells of all three: the largest of them, each over its limit.
Entry moving(const char* name, int frames, Entry::Cost cost, const Histories& histories) {
  constexpr double kDrift = 1.2, kEnergy = 0.05, kGrowth = 1 << 17;
  return {histories.name(name),
          std::to_string(frames) + " frames in which all moves",
          "error at most 1.2 times that after 256 frames, energy the same to 5 %, heap to 128 KiB: "
          "the largest of them, over its bound",
          1,
          [=](const std::string& recipe) {
            const Run of = run(moving_world(recipe, histories), frames);
            return std::max({of.drift() / kDrift, of.energy() / kEnergy, of.growth / kGrowth});
          },
          cost};
}

/// The exponential mean by itself, since no recipe has a weight of 0 or 1: the largest difference
/// after `frames` frames of random light from `expected`(mean of all, last).
double blended(float alpha, int frames, const std::function<double(double, double)>& expected) {
  constexpr int kWidth = 8, kHeight = 3;
  const AccumulationRule rule{.alpha = alpha};
  Guides wall(kWidth, kHeight);
  wall.view.width = kWidth;
  wall.view.height = kHeight;
  SurfaceHistory surface(kWidth, kHeight);
  Channels<float> noisy(kWidth, kHeight, 1);
  ComponentHistory history[2] = {{kWidth, kHeight, 1, HistoryExtras::kNone},
                                 {kWidth, kHeight, 1, HistoryExtras::kNone}};
  double sums[kHeight][kWidth] = {}, worst = 0;
  for (int t = 0; t < frames; ++t) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        wall.depth_normal[0].at(x, y) = 5;
        if (t > 0) surface.taps[0].at(x, y) = identity_taps(wall, x, y);
        const auto key = static_cast<std::uint64_t>((t * kHeight + y) * kWidth + x);
        noisy[0].at(x, y) = uniform_pair(mix_bits(key)).u;
        sums[y][x] += double{noisy[0].at(x, y)};
      }
    accumulate(wall, noisy, {&surface, nullptr, {}}, rule, history[(t + 1) % 2], history[t % 2],
               nullptr);
  }
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      worst = std::max(worst, std::abs(double{history[(frames - 1) % 2].data[0].at(x, y)} -
                                       expected(sums[y][x] / frames, double{noisy[0].at(x, y)})));
  return worst;
}

/// The mean itself, which no history keeps.
std::vector<Entry> mean_entries() {
  return {{"alpha-0", "an exponential mean of least weight 0, over 4096 frames",
           "the plain mean of all samples of 0..1: the largest difference", 2e-5,
           [](const std::string&) {
             return blended(0, 4096, [](double mean, double) { return mean; });
           }},
          {"alpha-1", "an exponential mean of least weight 1, over 64 frames",
           "the last frame, to the last bit", 0, [](const std::string&) {
             return blended(1, 64, [](double, double last) { return last; });
           }}};
}

}  // namespace

// History that drifts, or that gives up what it knows, would make the error grow.
std::vector<Entry> long_entries(const Histories& histories) {
  using Cost = Entry::Cost;
  std::vector<Entry> entries{at_rest("long-run", 2000, Cost::kSmall, histories),
                             at_rest("very-long-run", 100000, Cost::kLong, histories)};
  if (!histories.packed())
    for (Entry& entry : mean_entries()) entries.push_back(std::move(entry));
  entries.push_back(moving("moving-run", 1024, Cost::kSmall, histories));
  entries.push_back(moving("long-moving-run", 10016, Cost::kLong, histories));
  return entries;
}

}  // namespace holdfast::stability
