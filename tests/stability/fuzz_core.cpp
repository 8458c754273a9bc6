// Random sessions through the core's public door: see fuzz_main.h for the options.
#include "tests/stability/fuzz.h"
#include "tests/stability/fuzz_main.h"

int main(int argc, char** argv) {
  long filtered = 0, refused = 0;
  const auto run = [&](std::uint32_t seed) {
    const auto outcome = holdfast::test::fuzz_session(seed);
    filtered += outcome.filtered;
    refused += outcome.refused;
    return outcome.problem;
  };
  const auto summary = [&] {
    return std::to_string(filtered) + " frames filtered, " + std::to_string(refused) + " refused";
  };
  return holdfast::test::fuzz_main(argc, argv, run, summary);
}
