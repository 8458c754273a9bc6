#include <algorithm>
#include <cmath>
#include <string>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

constexpr const char* kPacked = "f16";

World world_of(const std::string& recipe, const char* history) {
  World world;
  world.recipe = recipe;
  world.history = history;
  return world;
}

/// Packed against floats: what rounding leaves in one frame.
double off_floats(const std::string& recipe) {
  return relative_difference(filter_world(world_of(recipe, kPacked)),
                             filter_world(world_of(recipe, "f32")));
}

/// Powers of two leave the bits of what is stored.
Entry power(int exponent) {
  const std::string text = "2^" + std::to_string(exponent);
  return {"f16-radiance-" + text,
          "all light times " + text + ", histories packed",
          "as with ordinary light, times " + text + ", to the last bit",
          {0, 1e-3},
          [=](const std::string& recipe) {
            World world = world_of(recipe, kPacked);
            const Outcome ordinary = filter_world(world);
            world.radiance = std::ldexp(1.0, exponent);
            return relative_difference(filter_world(world), ordinary, world.radiance);
          }};
}

/// RMSE of `id` beside the box, against the truth; infinite where something is not finite.
double error_beside_the_box(const World& world, int frames, PlaneId id) {
  const Outcome outcome = filter_world(world, frames);
  if (!all_finite(outcome)) return HUGE_VAL;
  const Frame frame = render(world, 0);
  const PlaneSet mean = truth(world, 0, 256);
  const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
  double squares = 0, count = 0;
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < world.height; ++y)
      for (int x = 0; x < world.width; ++x) {
        if (ids.at(x, y) == world.box_id) continue;
        const double found = double{outcome.results.back().at(id).channel(c).at(x, y)};
        squares += std::pow(found - double{mean.at(id).channel(c).at(x, y)}, 2);
        count += 1;
      }
  return std::sqrt(squares / count);
}

/// The box shines, and what lies beside it in the same rows must not go dark for that: the error
/// over that of floats.
Entry beside_a_bright_box(const std::string& text, float brightness) {
  return {"f16-beside-" + text,
          "glossy and indirect of the box times " + text + ", 128 frames at rest",
          "what is beside the box: its error over that of floats",
          {1.15, 1.1},
          [=](const std::string& recipe) {
            double error[2] = {}, worst = 0;
            for (const PlaneId id :
                 {PlaneId{PlaneKind::kGlossy, {}}, PlaneId{PlaneKind::kIndirect, {}}}) {
              for (int k = 0; k < 2; ++k) {
                World world = world_of(recipe, k == 0 ? kPacked : "f32");
                world.still = true;
                world.spoil = [=](Frame& frame, int) {
                  const auto ids = frame.planes.at({PlaneKind::kObjectId, {}}).ids();
                  Plane& plane = *frame.planes.find(id);
                  for (int c = 0; c < 3; ++c)
                    for (int y = 0; y < plane.height(); ++y)
                      for (int x = 0; x < plane.width(); ++x)
                        if (ids.at(x, y) == kBoxId) plane.channel(c).at(x, y) *= brightness;
                };
                error[k] = error_beside_the_box(world, 128, id);
              }
              worst = std::max(worst, error[0] / error[1]);
            }
            return worst;
          }};
}

}  // namespace

std::vector<Entry> packed_entries() {
  const Histories packed{kPacked};
  std::vector<Entry> entries{
      {"f16-against-floats", "ordinary light, histories packed",
       "as with floats, relative to each plane's largest value", 0.02, off_floats},
      power(-30),
      power(40),
      beside_a_bright_box("1e4", 1e4f),
      beside_a_bright_box("1e9", 1e9f),
      beside_a_bright_box("1e10", 1e10f)};
  for (auto& group : {scale_entries(packed), radiance_entries(packed), long_entries(packed)})
    entries.insert(entries.end(), group.begin(), group.end());
  return entries;
}

}  // namespace holdfast::stability
