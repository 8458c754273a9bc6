#include "server/frame_assembler.h"

#include <gtest/gtest.h>

#include "client/sdk/convert.h"
#include "client/sdk/frame_sender.h"
#include "tests/service/test_frames.h"

namespace holdfast::server {
namespace {

constexpr int kWidth = 7, kHeight = 5;

/// A frame as messages, which a test then damages.
class FrameAssembly : public ::testing::Test {
 protected:
  FrameAssembly() {
    config.denoiser = test::small_config(kWidth, kHeight);
    frame = std::make_shared<const Frame>(test::small_frame(config.denoiser, 4));
    client::PlaneWriter writer;
    client::FrameSender sender({frame, 0, {}, {}}, config.denoiser.planes, writer);
    wire::OutgoingMessage message;
    while (sender.next(message)) wire::parse_message(message.bytes, messages.emplace_back());
  }

  v1::FrameBegin& begin() { return *messages.front().mutable_frame_begin(); }
  /// The only chunk of a plane: the frame is small.
  v1::PlaneChunk& chunk(std::size_t plane) { return *messages[plane + 1].mutable_plane_chunk(); }

  /// The error of the frame; empty if it has none.
  std::string assemble() {
    FrameAssembler assembler(config);
    for (const v1::DenoiseRequest& message : messages) {
      if (message.has_frame_begin()) assembler.begin(message.frame_begin(), slot);
      if (message.has_plane_chunk()) assembler.add(wire::view_of(message.plane_chunk()));
      if (message.has_frame_end()) assembler.end(message.frame_end());
    }
    if (assembler.open()) assembler.abandon("the end of the stream");
    return slot.error ? slot.error->message() : "";
  }

  SessionConfig config;
  std::shared_ptr<const Frame> frame;
  std::vector<v1::DenoiseRequest> messages;
  FrameSlot slot;
};

TEST_F(FrameAssembly, RestoresTheFrameBitForBit) {
  ASSERT_EQ(assemble(), "");
  EXPECT_TRUE(test::same_bits(slot.frame.planes, frame->planes));
  EXPECT_EQ(slot.frame.index, frame->index);
  EXPECT_EQ(slot.frame.camera.view_from_world, frame->camera.view_from_world);
  EXPECT_EQ(slot.frame.camera.clip_from_view, frame->camera.clip_from_view);
  EXPECT_EQ(slot.frame.lights, frame->lights);
}

TEST_F(FrameAssembly, AcceptsAPlaneInPieces) {
  v1::DenoiseRequest second = messages[1];
  const std::string data = chunk(0).data();
  chunk(0).set_data(data.substr(0, 12));
  chunk(0).set_last(false);
  second.mutable_plane_chunk()->set_data(data.substr(12));
  second.mutable_plane_chunk()->set_offset(12);
  messages.insert(messages.begin() + 3, second);  // another plane in between
  ASSERT_EQ(assemble(), "");
  EXPECT_TRUE(test::same_bits(slot.frame.planes, frame->planes));
}

TEST_F(FrameAssembly, NamesAMissingCamera) {
  begin().clear_camera();
  EXPECT_EQ(assemble(), "camera of frame 4 must be present, but it is missing");
}

TEST_F(FrameAssembly, NamesAMatrixThatIsNoMatrix) {
  begin().mutable_camera()->mutable_clip_from_view()->mutable_values()->RemoveLast();
  EXPECT_EQ(assemble(), "clip_from_view of camera of frame 4 must have 16 numbers, but it is 15");
}

TEST_F(FrameAssembly, NamesAnUnknownLight) {
  begin().mutable_lights(0)->set_id(9);
  EXPECT_EQ(assemble(), "light 9 must be a light of the session, but it is unknown");
}

TEST_F(FrameAssembly, NamesALightListedTwice) {
  *begin().add_lights() = begin().lights(0);
  EXPECT_EQ(assemble(), "light 0 must be listed once in a frame, but it is listed twice");
}

TEST_F(FrameAssembly, NamesAPlaneOfTheWrongSize) {
  begin().mutable_planes(4)->set_height_px(6);
  EXPECT_EQ(assemble(), "plane light0.visibility must be 7x5, but it is 7x6");
}

TEST_F(FrameAssembly, NamesAGradientPlaneOfTheWrongSize) {
  config.denoiser.planes.push_back({PlaneKind::kGradient, {ComponentKind::kVisibility, 0}});
  v1::FramePlane& gradient = *begin().add_planes();
  gradient = begin().planes(0);  // of the frame's size
  gradient.set_plane(static_cast<std::uint32_t>(config.denoiser.planes.size() - 1));
  EXPECT_EQ(assemble(), "plane gradient.light0.visibility must be 3x2, but it is 7x5");
}

TEST_F(FrameAssembly, NamesAPlaneThatIsNotAnnounced) {
  begin().mutable_planes()->RemoveLast();
  EXPECT_EQ(assemble(),
            "plane light0.visibility must be announced in FrameBegin, but it is missing");
}

TEST_F(FrameAssembly, NamesAPlaneAnnouncedTwice) {
  *begin().add_planes() = begin().planes(1);
  EXPECT_EQ(assemble(), "plane normal must be announced once, but it is announced twice");
}

TEST_F(FrameAssembly, NamesAnUnknownPlane) {
  chunk(2).set_plane(77);
  EXPECT_EQ(assemble(),
            "plane number 77 must be less than the session's 5 planes, but it is unknown");
}

TEST_F(FrameAssembly, NamesATruncatedPlane) {
  messages.erase(messages.begin() + 5);
  EXPECT_EQ(
      assemble(),
      "plane light0.visibility of frame 4 must have 140 bytes, but it is cut off after 0 bytes");
}

TEST_F(FrameAssembly, NamesTooMuchData) {
  chunk(0).mutable_data()->append(8, '\0');
  EXPECT_EQ(assemble(), "plane depth must have 140 bytes, but it is at least 148 bytes");
}

TEST_F(FrameAssembly, NamesAnOffsetThatLeavesAGap) {
  chunk(0).set_offset(4);
  EXPECT_EQ(assemble(),
            "offset of a chunk of plane depth must be 0, where the last one ended, but it is 4");
}

TEST_F(FrameAssembly, NamesAChunkSentTwice) {
  messages.insert(messages.begin() + 2, messages[1]);
  EXPECT_EQ(assemble(),
            "chunk of plane depth must not follow the plane's last chunk, but it is at offset 0");
}

TEST_F(FrameAssembly, NamesAnOversizeChunk) {
  chunk(0).mutable_data()->resize((1 << 20) + 4);
  EXPECT_EQ(assemble(),
            "chunk of plane depth must have a multiple of 4 bytes, at least 4 and at most 1048576, "
            "but it is 1048580 bytes");
}

TEST_F(FrameAssembly, NamesAnEmptyChunkAndATornWord) {
  chunk(0).clear_data();
  EXPECT_NE(assemble().find("but it is 0 bytes"), std::string::npos);
  chunk(0).set_data("abc");
  EXPECT_NE(assemble().find("but it is 3 bytes"), std::string::npos);
}

TEST_F(FrameAssembly, NamesALastMarkAtTheWrongPlace) {
  chunk(0).set_last(false);
  EXPECT_EQ(
      assemble(),
      "last of a chunk of plane depth must be set exactly on the chunk that ends at 140 bytes, "
      "but it is not set at 140 bytes");
}

TEST_F(FrameAssembly, NamesAFrameEndOfAnotherFrame) {
  messages.back().mutable_frame_end()->set_index(5);
  EXPECT_EQ(assemble(), "index of FrameEnd must be 4 as in FrameBegin, but it is 5");
}

TEST_F(FrameAssembly, NamesAMissingFrameEnd) {
  messages.pop_back();
  EXPECT_EQ(assemble(),
            "frame 4 must end with FrameEnd, but it is followed by the end of the stream");
}

TEST_F(FrameAssembly, IsReadyForTheNextFrameAfterABadOne) {
  const auto good = messages;
  begin().clear_camera();
  ASSERT_NE(assemble(), "");
  messages = good;
  ASSERT_EQ(assemble(), "");
  EXPECT_TRUE(test::same_bits(slot.frame.planes, frame->planes));
}

}  // namespace
}  // namespace holdfast::server
