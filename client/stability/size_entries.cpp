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

/// Neither an overflow of sizes nor a pixel that is left out: a session of shadows alone.
double large_image(const std::string& recipe) {
  World world;
  world.recipe = recipe;
  world.width = 8192;
  world.height = 4320;
  DenoiserConfig config = session_of(world);
  Frame frame = render(world, 0);
  std::erase_if(config.planes, [](PlaneId id) {
    return id.kind == PlaneKind::kRoughness || id.kind == PlaneKind::kSpecular ||
           (id.kind >= PlaneKind::kGlossy && id.kind <= PlaneKind::kIndirectDirection);
  });
  for (const PlaneId id : session_of(world).planes)
    if (std::find(config.planes.begin(), config.planes.end(), id) == config.planes.end())
      frame.planes.remove(id);
  Denoiser denoiser(config);
  PlaneSet results;
  if (denoiser.filter(frame, results).non_finite_out > 0) return HUGE_VAL;
  const auto visibility = results.at(PlaneId::of_light(PlaneKind::kVisibility, 0)).channel(0);
  double worst = 0;
  for (int x = 0; x < world.width; ++x)
    worst = std::max(worst, std::abs(double{visibility.at(x, world.height - 1)} - 1));
  return worst;
}

}  // namespace

std::vector<Entry> size_entries() {
  std::vector<Entry> entries;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 64}, {64, 1}, {2, 2}, {3, 31}, {31, 3}, {65, 33}})
    entries.push_back(sized(width, height));
  entries.push_back({"size-8192x4320", "an image of 8192x4320",
                     "finite, and the last row is lit: by how much it is not", 1e-5, large_image,
                     Entry::Cost::kLarge});
  return entries;
}

}  // namespace holdfast::stability
