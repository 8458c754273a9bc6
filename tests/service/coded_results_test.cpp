// Answers with formats and codecs, whole and damaged, as the client library puts them together.
#include <functional>

#include <gtest/gtest.h>

#include "client/sdk/result_assembler.h"
#include "server/result_sender.h"
#include "tests/service/test_frames.h"

namespace holdfast::client {
namespace {

constexpr int kWidth = 37, kHeight = 21;

/// The messages of an answer by the server's own code, which a test then damages.
class CodedResults : public ::testing::TestWithParam<const char*> {
 protected:
  CodedResults() {
    config.denoiser = test::small_config(kWidth, kHeight);
    config.results = result_planes(config.denoiser);
    config.wire = GetParam();
    const auto pool = std::make_shared<server::PlanePool>(1);
    const auto answer = std::make_shared<server::Answer>(pool);
    answer->report =
        Denoiser(config.denoiser).filter(test::small_frame(config.denoiser, 0), answer->results);
    slot.answer = answer;
    wire::ChunkWriter chunks;
    server::ResultSender sender(slot, config, chunks);
    wire::OutgoingMessage message;
    while (sender.next(message)) wire::parse_message(message.bytes, messages.emplace_back());
  }

  v1::FramePlane& announced(int plane) {
    return *messages[0].mutable_frame_result()->mutable_planes(plane);
  }
  v1::PlaneChunk& chunk(std::size_t plane) { return *messages[plane + 1].mutable_plane_chunk(); }

  FrameOutput assemble() {
    ResultAssembler assembler(config.results);
    bool whole = assembler.begin(messages[0].frame_result(), {kWidth, kHeight}, {});
    for (std::size_t i = 1; i < messages.size(); ++i)
      whole = assembler.add(wire::view_of(messages[i].plane_chunk()));
    EXPECT_TRUE(whole);
    return assembler.take();
  }

  server::SessionConfig config;
  server::FrameSlot slot;
  std::vector<v1::DenoiseResponse> messages;
};

INSTANTIATE_TEST_SUITE_P(Profiles, CodedResults, ::testing::Values("exact", "balanced", "compact"),
                         [](const auto& profile) { return std::string(profile.param); });

TEST_P(CodedResults, ArriveWithinTheErrorOfTheirFormats) {
  const FrameOutput output = assemble();
  for (const Plane& sent : slot.answer->results)
    for (int c = 0; c < sent.channels(); ++c)
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          ASSERT_NEAR(output.planes.at(sent.id()).channel(c).at(x, y), sent.channel(c).at(x, y),
                      std::string(GetParam()) == "exact" ? 0.0f : 1.0f / 509.0f)
              << plane_name(sent.id());
}

TEST_P(CodedResults, ThatBreakTheProtocolAreRefused) {
  const auto good = messages;
  for (const auto& damage : std::vector<std::function<void()>>{
           [&] { announced(0).set_format(static_cast<v1::PlaneFormat>(99)); },
           [&] { announced(0).set_format(v1::PLANE_FORMAT_U8); },
           [&] { announced(0).set_codec(static_cast<v1::PlaneCodec>(7)); },
           [&] { announced(0).set_plane(1); }, [&] { chunk(0).clear_data(); },
           [&] { chunk(0).mutable_data()->pop_back(); },
           [&] { chunk(0).mutable_data()->append(4 * kWidth * kHeight * 3, 'x'); },
           [&] { chunk(0).set_offset(4); }, [&] { chunk(0).set_last(false); }}) {
    messages = good;
    damage();
    EXPECT_THROW(assemble(), std::runtime_error);
  }
  if (std::string(GetParam()) != "exact")
    for (const std::uint32_t bytes : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
      messages = good;
      chunk(0).set_plain_bytes(bytes);
      EXPECT_THROW(assemble(), std::runtime_error);
    }
  messages = good;
  EXPECT_NO_THROW(assemble());
}

}  // namespace
}  // namespace holdfast::client
