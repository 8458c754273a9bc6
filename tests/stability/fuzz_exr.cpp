// Damaged EXR files: see fuzz_main.h for the options.
#include "tests/sequence/temp_dir.h"
#include "tests/stability/fuzz_exr_case.h"
#include "tests/stability/fuzz_main.h"

int main(int argc, char** argv) {
  const holdfast::test::TempDir folder;
  long accepted = 0, refused = 0;
  const auto run = [&](std::uint32_t seed) {
    const auto outcome = holdfast::test::fuzz_exr(seed, folder.path());
    accepted += outcome.accepted;
    refused += outcome.refused;
    return outcome.problem;
  };
  const auto summary = [&] {
    return std::to_string(accepted) + " files read, " + std::to_string(refused) + " refused";
  };
  return holdfast::test::fuzz_main(argc, argv, run, summary);
}
