// Frames whose planes have formats and codecs, whole and damaged, as the server puts them together.
#include <functional>

#include <gtest/gtest.h>

#include "proto/wire_profile.h"
#include "server/frame_assembler.h"
#include "tests/service/raw_client.h"

namespace holdfast::server {
namespace {

constexpr int kWidth = 37, kHeight = 21;
constexpr std::size_t kDepth = 0, kNormal = 1, kId = 2;  // positions in small_config

/// A frame as the messages of profile `compact`, which a test then damages. Depth, normals and ids
/// are the same everywhere, so that their chunks are much smaller than what they hold.
class CodedFrame : public ::testing::TestWithParam<const char*> {
 protected:
  CodedFrame() {
    config.denoiser = test::small_config(kWidth, kHeight);
    frame = test::small_frame(config.denoiser, 4);
    messages = test::RawStream::messages(frame, config.denoiser, GetParam());
  }

  v1::FramePlane& announced(std::size_t plane) {
    return *messages.front().mutable_frame_begin()->mutable_planes(static_cast<int>(plane));
  }
  v1::PlaneChunk& chunk(std::size_t plane) { return *messages[plane + 1].mutable_plane_chunk(); }

  /// The error of the frame; empty if it has none.
  std::string assemble() {
    for (const v1::DenoiseRequest& message : messages) {
      if (message.has_frame_begin()) assembler.begin(message.frame_begin(), slot);
      if (message.has_plane_chunk()) assembler.add(wire::view_of(message.plane_chunk()));
      if (message.has_frame_end()) assembler.end(message.frame_end());
    }
    return slot.error ? slot.error->message() : "";
  }

  SessionConfig config;
  Frame frame;
  std::vector<v1::DenoiseRequest> messages;
  FrameAssembler assembler{config};
  FrameSlot slot;
};

INSTANTIATE_TEST_SUITE_P(Profiles, CodedFrame, ::testing::Values("balanced", "compact"),
                         [](const auto& profile) { return std::string(profile.param); });

TEST_P(CodedFrame, ArrivesWithWhatItsFormatsMakeOfIt) {
  ASSERT_EQ(assemble(), "");
  const PlaneSet& got = slot.frame.planes;
  for (const PlaneId id :
       {PlaneId{PlaneKind::kDepth, {}}, PlaneId{PlaneKind::kObjectId, {}},
        PlaneId{PlaneKind::kNormal, {}}, PlaneId::of_light(PlaneKind::kVisibility, 0)})
    for (int c = 0; c < frame.planes.at(id).channels(); ++c)
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          ASSERT_EQ(got.at(id).words(c).at(x, y), frame.planes.at(id).words(c).at(x, y))
              << plane_name(id) << ": values that every format keeps";
}

TEST_P(CodedFrame, NamesAnUnknownFormatAndOneForOtherPlanes) {
  announced(kDepth).set_format(static_cast<v1::PlaneFormat>(77));
  EXPECT_EQ(assemble(), "format of plane depth must be one that suits the plane, but it is 77");
  announced(kDepth).set_format(v1::PLANE_FORMAT_U8);
  EXPECT_EQ(assemble(), "format of plane depth must be one that suits the plane, but it is 7");
  announced(kDepth).set_format(static_cast<v1::PlaneFormat>(-1));
  EXPECT_EQ(assemble(), "format of plane depth must be one that suits the plane, but it is -1");
}

TEST_P(CodedFrame, NamesAnUnknownCodec) {
  announced(kNormal).set_codec(static_cast<v1::PlaneCodec>(3));
  EXPECT_EQ(assemble(), "codec of plane normal must be a known one, but it is 3");
}

TEST_P(CodedFrame, NamesCorruptData) {
  const std::string codec = std::string(GetParam()) == "balanced" ? "lz4" : "zstd";
  const auto good = messages;
  for (const auto& damage : std::vector<std::function<void(std::string&)>>{
           [](std::string& data) { data.clear(); }, [](std::string& data) { data.pop_back(); },
           [](std::string& data) { data.erase(0, 1); },
           [](std::string& data) { data.assign(data.size(), '\xff'); },
           [](std::string& data) { data.append(7, '\0'); }}) {
    messages = good;
    damage(*chunk(kNormal).mutable_data());
    EXPECT_EQ(assemble(), "data of a chunk of plane normal must be 3108 bytes of " + codec +
                              ", but it is corrupt");
  }
  messages = good;
  EXPECT_EQ(assemble(), "") << "the next frame is read as if nothing had been";
}

TEST_P(CodedFrame, NamesDataThatHoldsMoreOrLessThanItSays) {
  chunk(kId).set_plain_bytes(kWidth * kHeight - 1);
  EXPECT_NE(assemble().find("must be 776 bytes of "), std::string::npos) << assemble();
  chunk(kId).set_plain_bytes(kWidth * kHeight + 1);
  EXPECT_EQ(assemble(), "plane objectId must have 777 bytes, but it is at least 778 bytes");
  chunk(kId).set_plain_bytes(0);
  EXPECT_NE(assemble().find("but it is 0 bytes"), std::string::npos);
  chunk(kId).set_plain_bytes(0xffffffffu);
  EXPECT_EQ(assemble(),
            "chunk of plane objectId must have a multiple of 1 bytes, at least 1 and at most "
            "1048576, but it is 4294967295 bytes");
}

TEST_P(CodedFrame, NamesDataLargerThanWhatItHolds) {
  chunk(kId).mutable_data()->assign(kWidth * kHeight + 1, '\0');
  EXPECT_EQ(assemble(),
            "data of a chunk of plane objectId must be at most its 777 bytes, but it is 778 bytes");
}

TEST_P(CodedFrame, NamesATornElement) {
  chunk(kNormal).set_plain_bytes(3106);
  EXPECT_NE(assemble().find("must have a multiple of 4 bytes"), std::string::npos) << assemble();
}

TEST_P(CodedFrame, NamesASizeBeforeACodecThatIsNotThere) {
  announced(kId).set_codec(v1::PLANE_CODEC_NONE);
  EXPECT_EQ(assemble(),
            "plain_bytes of a chunk of plane objectId must be 0 without a codec, but it is 777");
}

TEST_P(CodedFrame, TakesWhatACodecDidNotMakeSmallerAsItIs) {
  const std::string ids(kWidth * kHeight, '\1');
  chunk(kId).set_data(ids);
  ASSERT_EQ(assemble(), "");
  EXPECT_EQ(slot.frame.planes.at({PlaneKind::kObjectId, {}}).ids().at(36, 20), 1u);
}

TEST_P(CodedFrame, StopsABombAtTheSizeOfItsChunk) {
  const auto codec = std::string(GetParam()) == "balanced" ? wire::Codec::kLz4 : wire::Codec::kZstd;
  const std::vector<std::byte> zeros(16u << 20);
  std::string bomb(zeros.size(), '\0');
  wire::BlockCodec coder;
  bomb.resize(
      coder.compress(codec, zeros.data(), zeros.size(), reinterpret_cast<std::byte*>(bomb.data())));
  chunk(kNormal).set_data(bomb.substr(0, 3000));
  EXPECT_NE(assemble().find("but it is corrupt"), std::string::npos) << assemble();
  chunk(kNormal).set_data(bomb);
  EXPECT_NE(assemble(), "");
}

TEST_P(CodedFrame, FormatsMayChangeFromFrameToFrame) {
  ASSERT_EQ(assemble(), "");
  messages = test::RawStream::messages(frame, config.denoiser, "exact");
  ASSERT_EQ(assemble(), "");
  EXPECT_TRUE(test::same_bits(slot.frame.planes, frame.planes));
  messages = test::RawStream::messages(frame, config.denoiser, GetParam());
  EXPECT_EQ(assemble(), "");
}

TEST(CodedFrames, IdsBeyondAByteTravelWiderAndWhole) {
  SessionConfig config;
  config.denoiser = test::small_config(kWidth, kHeight);
  for (const std::uint32_t id : {255u, 256u, 65536u, 0xffffffffu}) {
    Frame frame = test::small_frame(config.denoiser, 0);
    frame.planes.find({PlaneKind::kObjectId, {}})->ids().at(20, 20) = id;
    FrameAssembler assembler{config};
    FrameSlot slot;
    const auto messages = test::RawStream::messages(frame, config.denoiser, "compact");
    for (const auto& message : messages) {
      if (message.has_frame_begin()) assembler.begin(message.frame_begin(), slot);
      if (message.has_plane_chunk()) assembler.add(wire::view_of(message.plane_chunk()));
      if (message.has_frame_end()) assembler.end(message.frame_end());
    }
    ASSERT_FALSE(slot.error) << slot.error->message();
    EXPECT_EQ(slot.frame.planes.at({PlaneKind::kObjectId, {}}).ids().at(20, 20), id);
    EXPECT_EQ(slot.frame.planes.at({PlaneKind::kObjectId, {}}).ids().at(0, 0), 1u);
  }
}

}  // namespace
}  // namespace holdfast::server
