// Damaged messages of clients: see fuzz_main.h for the options.
#include <google/protobuf/stubs/logging.h>

#include "tests/stability/fuzz_main.h"
#include "tests/stability/fuzz_stream_case.h"

int main(int argc, char** argv) {
  google::protobuf::SetLogHandler(nullptr);  // it complains of each message
  long accepted = 0, refused = 0;
  const auto run = [&](std::uint32_t seed) {
    const auto outcome = holdfast::test::fuzz_stream(seed);
    accepted += outcome.accepted;
    refused += outcome.refused;
    return outcome.problem;
  };
  const auto summary = [&] {
    return std::to_string(accepted) + " messages and frames read, " + std::to_string(refused) +
           " refused";
  };
  return holdfast::test::fuzz_main(argc, argv, run, summary);
}
