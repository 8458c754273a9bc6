#include <google/protobuf/stubs/logging.h>
#include <gtest/gtest.h>

#include "tests/stability/fuzz_server_case.h"
#include "tests/stability/fuzz_stream_case.h"

namespace holdfast::test {
namespace {

/// Cases of seeds from 0 on; some damage is refused, and some is harmless.
template <class Case>
void run(int cases, Case fuzz) {
  google::protobuf::SetLogHandler(nullptr);  // it complains of each message
  int accepted = 0, refused = 0;
  for (int seed = 0; seed < cases; ++seed) {
    const ReadOutcome outcome = fuzz(static_cast<std::uint32_t>(seed));
    ASSERT_EQ(outcome.problem, "") << "seed " << seed;
    accepted += outcome.accepted;
    refused += outcome.refused;
  }
  EXPECT_GT(accepted, cases / 5);
  EXPECT_GT(refused, cases / 4);
}

TEST(FuzzStream, OurReaderOfChunksAndTheGeneratedClassReadAnyBytesAlike) {
  run(3000, fuzz_chunk_message);
}
TEST(FuzzStream, AnyBlockIsDecodedWithinItsPieceOrRefused) { run(2000, fuzz_block); }
TEST(FuzzStream, AnyMessagesAreRefusedByNameAndTheNextFrameIsWhole) { run(1000, fuzz_frames); }

TEST(FuzzServer, HostileStreamsEndAndHarmNeitherTheirSessionNorOthers) {
  ServerFuzz fuzz;
  run(200, [&](std::uint32_t seed) { return fuzz.run(seed); });
}

}  // namespace
}  // namespace holdfast::test
