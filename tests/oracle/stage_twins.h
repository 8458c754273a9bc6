#pragma once

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "core/history/component_history.h"
#include "core/oracle/history.h"
#include "tests/core/isa_guard.h"
#include "tests/core/small_world.h"

/// One stage at a time: the same numbers to the kernels in floats and to the oracle in doubles.
namespace holdfast::test {

inline constexpr std::pair<int, int> kStageSizes[] = {{1, 1},  {1, 7},   {5, 3},
                                                      {17, 9}, {67, 13}, {131, 34}};

/// Calls body() on every instruction set, on one thread and on four.
template <class Body>
void on_every_isa_and_threads(const Body& body) {
  const IsaGuard guard;
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism, 4);
  for (const Isa isa : available_isas())
    for (const int threads : {1, 4}) {
      SCOPED_TRACE(std::string(isa_name(isa)) + " on " + std::to_string(threads));
      select_isa(isa);
      tbb::task_arena(threads).execute(body);
    }
}

/// Walls of two depths and ids, leaning and rough, with sky.
inline Guides leaning_walls(int width, int height, Random& random) {
  const Camera camera = perspective_camera(width, height, {1, 2, 3}, {0, 0, -1});
  Guides guides = empty_guides(camera, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (random.uniform() < 0.1 && width * height > 1) continue;
      const bool far = (x / 5 + y / 3) % 3 == 0;
      const float tilt = (far ? 0.25f : -0.15f) + random.real(-0.02f, 0.02f);
      set_pixel(guides, x, y, (far ? 9.0f : 4.0f) + random.real(0, 0.02f),
                glm::normalize(glm::vec3(tilt, 0.1f, 1.0f)), far ? 1 : 2);
    }
  for (int c = 0; c < 4; ++c) poison_padding(guides.depth_normal[c]);
  return guides;
}

inline oracle::Image image_of(const Channels<float>& in, int first, int count) {
  oracle::Image out(in.width(), in.height(), count);
  oracle::for_each_pixel(in.width(), in.height(), [&](int x, int y) {
    for (int c = 0; c < count; ++c) out.at(x, y, c) = double{in[first + c].at(x, y)};
  });
  return out;
}

inline oracle::Surfaces surfaces_of(const Guides& guides) {
  oracle::Surfaces out;
  out.width = guides.view.width;
  out.height = guides.view.height;
  out.view = guides.view;
  out.depth = image_of(guides.depth_normal, 0, 1);
  out.normal = image_of(guides.depth_normal, 1, 3);
  oracle::for_each_pixel(out.width, out.height,
                         [&](int x, int y) { out.ids.push_back(guides.id[0].at(x, y)); });
  return out;
}

/// Random taps into `previous`, none at a fifth of the pixels, for kernels and for the oracle.
inline void random_taps(const Guides& now, const Guides& previous, Random& random,
                        Channels<Taps>& taps, oracle::Past& past) {
  const int width = now.view.width, height = now.view.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Taps& of = taps[0].at(x, y) = {};
      oracle::Taps& same = past.at(x, y) = {};
      const bool none = random.uniform() < 0.2 || !(now.depth().at(x, y) > 0.0f);
      const int left = static_cast<int>(random.uniform(0, std::max(width - 1, 1)));
      const int top = static_cast<int>(random.uniform(0, std::max(height - 1, 1)));
      if (none) continue;
      of.offset = static_cast<std::int32_t>(top * previous.depth().stride + left);
      float sum = 0;
      for (int k = 0; k < 4; ++k) {
        const int px = left + k % 2, py = top + k / 2;
        const bool shown = px < width && py < height && previous.depth().at(px, py) > 0.0f;
        of.weight[k] = shown ? random.real(0.1f, 1) : 0.0f;
        sum += of.weight[k];
      }
      for (int k = 0; k < 4; ++k) {
        if (!(of.weight[k] > 0)) continue;
        of.weight[k] /= sum;
        same.of[same.count++] = {left + k % 2, top + k / 2, double{of.weight[k]}};
      }
    }
}

/// A history that may hold anything that one holds.
inline void fill_history(ComponentHistory& history, Random& random, float largest) {
  for (int c = 0; c < history.data.count(); ++c) {
    fill_random(history.data[c], random, 0, largest);
    poison_padding(history.data[c]);
  }
  fill_random(history.samples(), random, 1, 64);
  if (history.has_moments())  // a second moment is no less than the square of the first
    for (int y = 0; y < history.data.height(); ++y)
      for (int x = 0; x < history.data.width(); ++x)
        history.moment(2).at(x, y) += history.moment(1).at(x, y) * history.moment(1).at(x, y);
}

inline oracle::History history_of(const ComponentHistory& history) {
  oracle::History out;
  out.signal = image_of(history.data, 0, history.channels);
  out.samples = image_of(history.data, history.channels, 1);
  if (history.has_moments()) out.moments = image_of(history.data, history.channels + 1, 2);
  return out;
}

/// All pixels agree to `tolerance`, but for `share` of them, in which a choice may have tipped.
inline void expect_close(const Channels<float>& found, int first, const oracle::Image& expected,
                         double tolerance, double share, const std::string& what) {
  double beyond = 0, worst = 0;
  oracle::for_each_pixel(expected.width(), expected.height(), [&](int x, int y) {
    double error = 0;
    for (int c = 0; c < expected.channels(); ++c) {
      const double value = double{found[first + c].at(x, y)};
      const double d = std::abs(value - expected.at(x, y, c));
      error = std::isfinite(value) ? std::max(error, d) : HUGE_VAL;
    }
    beyond += error > tolerance ? 1 : 0;
    worst = std::max(worst, error);
  });
  EXPECT_LE(beyond, share * expected.width() * expected.height())
      << what << ' ' << expected.width() << 'x' << expected.height() << ": " << worst;
}

}  // namespace holdfast::test
