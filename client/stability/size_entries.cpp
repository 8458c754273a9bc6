#include <algorithm>
#include <cmath>
#include <string>

#include "client/stability/entry.h"
#include "client/stability/outcome.h"

namespace holdfast::stability {
namespace {

constexpr int kStillFrames = 48;

/// Images so small that neighbours are missing, in a scene at rest: history alone takes noise away.
Entry sized(int width, int height) {
  const std::string text = std::to_string(width) + "x" + std::to_string(height);
  return {"size-" + text,
          "images of " + text + ", at rest",
          "less noise than in the input, relative to it",
          {kHelps, kGhosts},
          [=](const std::string& recipe) {
            World world;
            world.recipe = recipe;
            world.width = width;
            world.height = height;
            world.still = true;
            world.fov = 1.4;
            world.roughness = 0.6f;
            return noise_left(world, kStillFrames);
          }};
}

/// Three large frames: neither overflow of sizes nor a pixel that is left out.
double large_image(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.width = 8192;
  world.height = 4320;
  world.still = true;
  Denoiser denoiser(session_of(world));
  PlaneSet results;
  const Frame frame = render(world, 0);
  const FrameReport report = denoiser.filter(frame, results);
  if (report.non_finite_out > 0) return HUGE_VAL;
  double least = HUGE_VAL;
  const PlaneId id{PlaneKind::kComposite, {}};
  for (const int y : {0, 1, 2159, 4318, 4319})
    for (int x = 0; x < world.width; ++x)
      least = std::min(least, double{results.at(id).channel(1).at(x, y)});
  return least > 0 ? 0 : 1;
}

}  // namespace

std::vector<Entry> size_entries() {
  std::vector<Entry> entries;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 64}, {64, 1}, {2, 2}, {3, 31}, {31, 3}, {65, 33}})
    entries.push_back(sized(width, height));
  entries.push_back({"size-8192x4320", "an image of 8192x4320",
                     "finite, and lit to the last row: 1 if not", 0, large_image,
                     Entry::Cost::kLarge});
  return entries;
}

}  // namespace holdfast::stability
