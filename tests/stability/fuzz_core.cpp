// fuzz_core [--seconds N] [--seed FIRST] [--sessions N]: random sessions through the core's public
// door until the time is up, one seed after the other. Exit code 1 at the first problem, whose seed
// it names; `fuzz_core --seed S --sessions 1` is that session again.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/stability/fuzz.h"

namespace {

int usage() {
  std::fprintf(stderr, "usage: fuzz_core [--seconds N] [--seed FIRST] [--sessions N]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 60;
  std::uint32_t seed = 1000000;
  long sessions = -1;
  for (int i = 1; i < argc; i += 2) {
    char* end = nullptr;
    if (i + 1 == argc) return usage();
    const double value = std::strtod(argv[i + 1], &end);
    if (*end != '\0' || value < 0) return usage();
    if (std::strcmp(argv[i], "--seconds") == 0)
      seconds = value;
    else if (std::strcmp(argv[i], "--seed") == 0)
      seed = static_cast<std::uint32_t>(value);
    else if (std::strcmp(argv[i], "--sessions") == 0)
      sessions = static_cast<long>(value);
    else
      return usage();
  }
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  long done = 0, filtered = 0, refused = 0;
  for (; (sessions < 0 || done < sessions) && elapsed() < seconds; ++done, ++seed) {
    const auto outcome = holdfast::test::fuzz_session(seed);
    if (!outcome.problem.empty()) {
      std::fprintf(stderr, "%s\n", outcome.problem.c_str());
      return 1;
    }
    filtered += outcome.filtered;
    refused += outcome.refused;
  }
  std::printf("%ld sessions, %ld frames filtered, %ld refused, next seed %u\n", done, filtered,
              refused, seed);
  return 0;
}
