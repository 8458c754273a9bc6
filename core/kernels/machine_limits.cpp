#include "core/kernels/machine_limits.h"

#include <algorithm>
#include <ctime>
#include <vector>

#include "core/kernels/math.h"
#include "core/kernels/variants.h"

namespace holdfast {
namespace {

constexpr int kChains = 8;     // that do not wait for each other: enough for two units of latency 4
constexpr int kLanes = 256;    // of each
constexpr int kRounds = 16;    // multiply-adds between a load and a store
constexpr int kRepeats = 400;  // of a measurement
constexpr int kTries = 20;     // the best counts: others had the core meanwhile

struct Chains {
  float (&value)[kChains][kLanes];
  float factor, term;
};

HOLDFAST_INLINE void chains_body(const Chains& a) {
  float *v0 = a.value[0], *v1 = a.value[1], *v2 = a.value[2], *v3 = a.value[3], *v4 = a.value[4],
        *v5 = a.value[5], *v6 = a.value[6], *v7 = a.value[7];
  const float factor = a.factor, term = a.term;
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    float x0 = v0[i], x1 = v1[i], x2 = v2[i], x3 = v3[i], x4 = v4[i], x5 = v5[i], x6 = v6[i],
          x7 = v7[i];
#pragma GCC unroll 16
    for (int round = 0; round < kRounds; ++round) {
      x0 = x0 * factor + term;
      x1 = x1 * factor + term;
      x2 = x2 * factor + term;
      x3 = x3 * factor + term;
      x4 = x4 * factor + term;
      x5 = x5 * factor + term;
      x6 = x6 * factor + term;
      x7 = x7 * factor + term;
    }
    v0[i] = x0, v1[i] = x1, v2[i] = x2, v3[i] = x3;
    v4[i] = x4, v5[i] = x5, v6[i] = x6, v7[i] = x7;
  }
}

struct Move {
  const float* from;
  float *to, factor;
  int count;
};

HOLDFAST_INLINE void move_body(const Move& a) {
  const float* from = a.from;
  float *to = a.to, factor = a.factor;
#pragma GCC ivdep
  for (int i = 0; i < a.count; ++i) to[i] = factor * from[i];
}

HOLDFAST_KERNEL(chains, Chains)
HOLDFAST_KERNEL(move, Move)

double thread_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

/// Least processor time of `work`, ns.
template <class Work>
double least_ns(const Work& work) {
  double least = 1e30;
  for (int i = 0; i < kTries; ++i) {
    const double start = thread_ns();
    work();
    least = std::min(least, thread_ns() - start);
  }
  return least;
}

double multiply_adds_per_ns() {
  alignas(64) float value[kChains][kLanes] = {};
  const double ns = least_ns([&] {
    for (int i = 0; i < kRepeats; ++i) chains({value, 0.5f, 1.0f});
  });
  return static_cast<double>(kRepeats) * kRounds * kChains * kLanes / ns;
}

double copy_gb_per_s() {
  constexpr int kCount = 1 << 23;  // 32 MiB there and 32 back
  const std::vector<float> from(kCount, 1.0f);
  std::vector<float> to(kCount);
  const double ns = least_ns([&] { move({from.data(), to.data(), 2.0f, kCount}); });
  return 2.0 * sizeof(float) * kCount / ns;
}

}  // namespace

MachineLimits measure_machine_limits() { return {multiply_adds_per_ns(), copy_gb_per_s()}; }

}  // namespace holdfast
