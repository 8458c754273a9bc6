#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace holdfast::fit {

/// Minimises `f` by the downhill simplex of Nelder and Mead (Computer Journal 1965) with the usual
/// coefficients 1, 2, 1/2, 1/2, from a simplex of edge `step` at `start`. Ends after `iterations`,
/// or when
/// the values at the corners agree to `tolerance`. Deterministic.
template <std::size_t N, class F>
std::array<double, N> nelder_mead(const std::array<double, N>& start, double step, int iterations,
                                  double tolerance, const F& f) {
  struct Corner {
    std::array<double, N> x;
    double value;
  };
  std::array<Corner, N + 1> s;
  for (std::size_t i = 0; i <= N; ++i) {
    s[i].x = start;
    if (i > 0) s[i].x[i - 1] += step;
    s[i].value = f(s[i].x);
  }
  const auto by_value = [](const Corner& a, const Corner& b) { return a.value < b.value; };
  for (int k = 0; k < iterations; ++k) {
    std::stable_sort(s.begin(), s.end(), by_value);
    Corner& worst = s[N];
    if (worst.value - s[0].value <= tolerance) break;
    std::array<double, N> centre{};
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t d = 0; d < N; ++d) centre[d] += s[i].x[d] / static_cast<double>(N);
    const auto moved = [&](double t) {
      Corner c;
      for (std::size_t d = 0; d < N; ++d) c.x[d] = centre[d] + t * (worst.x[d] - centre[d]);
      c.value = f(c.x);
      return c;
    };
    const Corner reflected = moved(-1.0);
    if (reflected.value < s[0].value) {
      const Corner expanded = moved(-2.0);
      worst = expanded.value < reflected.value ? expanded : reflected;
    } else if (reflected.value < s[N - 1].value) {
      worst = reflected;
    } else {
      const Corner contracted = moved(reflected.value < worst.value ? -0.5 : 0.5);
      if (contracted.value < std::min(reflected.value, worst.value)) {
        worst = contracted;
        continue;
      }
      for (std::size_t i = 1; i <= N; ++i) {
        for (std::size_t d = 0; d < N; ++d) s[i].x[d] = 0.5 * (s[0].x[d] + s[i].x[d]);
        s[i].value = f(s[i].x);
      }
    }
  }
  return std::min_element(s.begin(), s.end(), by_value)->x;
}

}  // namespace holdfast::fit
