#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace holdfast::test {

/// The program PROGRAM [--seconds N] [--seed FIRST] [--cases N]: cases until the time is up, one
/// seed after the other. `run(seed)` returns what is wrong, empty if nothing is; `summary()` a line
/// of what was seen. Exit code 1 at the first problem, whose seed it names; `--seed S --cases 1` is
/// that case again.
template <class Run, class Summary>
int fuzz_main(int argc, char** argv, const Run& run, const Summary& summary) {
  double seconds = 60, cases = -1;
  std::uint32_t seed = 1000000;
  for (int i = 1; i < argc; i += 2) {
    char* end = nullptr;
    const double value = i + 1 < argc ? std::strtod(argv[i + 1], &end) : -1;
    const bool usable = value >= 0 && *end == '\0';
    if (usable && std::strcmp(argv[i], "--seconds") == 0)
      seconds = value;
    else if (usable && std::strcmp(argv[i], "--seed") == 0)
      seed = static_cast<std::uint32_t>(value);
    else if (usable && std::strcmp(argv[i], "--cases") == 0)
      cases = value;
    else
      return std::fprintf(stderr, "usage: %s [--seconds N] [--seed FIRST] [--cases N]\n", argv[0]),
             2;
  }
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double done = 0;
  for (; (cases < 0 || done < cases) && elapsed() < seconds; ++done, ++seed) {
    const std::string problem = run(seed);
    if (problem.empty()) continue;
    std::fprintf(stderr, "seed %u: %s\n", seed, problem.c_str());
    return 1;
  }
  std::printf("%.0f cases, next seed %u: %s\n", done, seed, summary().c_str());
  return 0;
}

}  // namespace holdfast::test
