#include "proto/chunk_message.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "holdfast/v1/denoise_service.pb.h"
#include "proto/chunk_writer.h"

namespace holdfast::wire {
namespace {

std::string text_of(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  EXPECT_TRUE(buffer.Dump(&slices).ok());
  std::string text;
  for (const grpc::Slice& slice : slices)
    text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return text;
}

/// `bytes` in pieces of random sizes, some of them empty.
grpc::ByteBuffer in_pieces(const std::string& bytes, std::mt19937& random) {
  std::vector<grpc::Slice> slices;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t most = random() % 3 == 0 ? 3 : 1000;
    const std::size_t size = std::min<std::size_t>(random() % most, bytes.size() - at);
    slices.emplace_back(bytes.data() + at, size);
    at += size;
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

v1::PlaneChunk chunk_of(const ChunkFields& fields, const std::string& data) {
  v1::PlaneChunk chunk;
  chunk.set_plane(fields.plane);
  chunk.set_offset(fields.offset);
  chunk.set_last(fields.last);
  chunk.set_data(data);
  chunk.set_plain_bytes(fields.plain_bytes);
  chunk.set_shared_bytes(fields.shared_bytes);
  return chunk;
}

/// `data` in two slices, so that the lengths that are written are those of all.
std::vector<grpc::Slice> pieces_of(const std::string& data) {
  const std::size_t first = data.size() / 3;
  return {grpc::Slice(data.data(), first), grpc::Slice(data.data() + first, data.size() - first)};
}

/// Values where the lengths of their encodings change, and the defaults.
std::vector<ChunkFields> many_fields() {
  std::vector<ChunkFields> out;
  for (const std::uint32_t plane : {0u, 1u, 127u, 128u, 0xffffffffu})
    for (const std::uint64_t offset : {0ull, 127ull, 128ull, 1ull << 20, 1ull << 35, ~0ull})
      for (const bool last : {false, true})
        for (const std::uint32_t plain : {0u, 4u, 1u << 20, 0xffffffffu})
          for (const std::uint32_t shared : {0u, 128u, 0xffffffffu})
            out.push_back({plane, offset, last, plain, shared});
  return out;
}

const std::size_t kSizes[] = {0, 1, 4, 127, 128, 16383, 16384, 1u << 20};

TEST(ChunkMessage, IsByteForByteWhatTheGeneratedClassWrites) {
  for (const std::size_t size : kSizes) {
    const std::string data(size, 'x');
    for (const ChunkFields& fields : many_fields()) {
      if (size > 16384 && fields.plane > 1) continue;  // time
      const std::string ours = text_of(chunk_message(fields, pieces_of(data)));
      v1::DenoiseRequest request;
      *request.mutable_plane_chunk() = chunk_of(fields, data);
      ASSERT_TRUE(ours == request.SerializeAsString()) << size << " bytes at " << fields.offset;
      v1::DenoiseResponse response;
      *response.mutable_plane_chunk() = chunk_of(fields, data);
      ASSERT_TRUE(ours == response.SerializeAsString());
    }
  }
}

TEST(ChunkReader, ReadsWhatTheGeneratedClassWritesInAnyPieces) {
  std::mt19937 random(1);
  ChunkReader reader;
  for (const std::size_t size : kSizes) {
    if (size > 16384) continue;
    std::string data(size, 0);
    for (char& c : data) c = static_cast<char>(random());
    for (const ChunkFields& fields : many_fields()) {
      v1::DenoiseRequest request;
      *request.mutable_plane_chunk() = chunk_of(fields, data);
      const ChunkView* const view = reader.read(in_pieces(request.SerializeAsString(), random));
      ASSERT_NE(view, nullptr);
      EXPECT_EQ(view->fields, fields);
      EXPECT_EQ(view->data_bytes, size);
      std::string joined;
      for (const std::string_view piece : view->data) joined += piece;
      ASSERT_TRUE(joined == data);
    }
  }
}

TEST(ChunkReader, LeavesOtherMessagesToTheGeneratedClass) {
  ChunkReader reader;
  std::mt19937 random(1);
  v1::DenoiseRequest hello, end, begin;
  hello.mutable_hello()->set_session_id("id");
  end.mutable_frame_end()->set_index(3);
  begin.mutable_frame_begin()->set_index(3);
  for (const v1::DenoiseRequest& message : {hello, end, begin, v1::DenoiseRequest()})
    EXPECT_EQ(reader.read(in_pieces(message.SerializeAsString(), random)), nullptr);
}

/// Whatever was damaged: if we read a chunk, the generated class reads the same.
TEST(ChunkReader, AgreesWithTheGeneratedClassOnDamagedMessages) {
  std::mt19937 random(2);
  ChunkReader reader;
  int read = 0, left = 0;
  for (int i = 0; i < 200000; ++i) {
    v1::DenoiseRequest request;
    const ChunkFields fields{static_cast<std::uint32_t>(random() % 3), random() % 1000,
                             random() % 2 == 0, static_cast<std::uint32_t>(random() % 300)};
    *request.mutable_plane_chunk() = chunk_of(fields, std::string(random() % 12, 'x'));
    std::string bytes = request.SerializeAsString();
    for (auto k = random() % 4; k > 0; --k) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0: bytes[at] = static_cast<char>(random()); break;
        case 1: bytes.insert(at, 1, static_cast<char>(random())); break;
        case 2: bytes.erase(at, 1 + random() % 3); break;
        default: bytes += bytes.substr(at);
      }
      if (bytes.empty()) bytes = "x";
    }
    const ChunkView* const view = reader.read(in_pieces(bytes, random));
    if (view == nullptr) {
      ++left;
      continue;
    }
    ++read;
    v1::DenoiseRequest parsed;
    ASSERT_TRUE(parsed.ParseFromString(bytes));
    ASSERT_TRUE(parsed.has_plane_chunk());
    const ChunkView theirs = view_of(parsed.plane_chunk());
    ASSERT_EQ(view->fields, theirs.fields);
    std::string joined;
    for (const std::string_view piece : view->data) joined += piece;
    ASSERT_TRUE(joined == theirs.data.front());
  }
  EXPECT_GT(read, 20000);
  EXPECT_GT(left, 20000);
}

Plane noise(PlaneKind kind, int width, int height) {
  Plane plane({kind, {}}, width, height);
  std::mt19937 random(3);
  for (int c = 0; c < plane.channels(); ++c)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        plane.words(c).at(x, y) = static_cast<std::uint32_t>(random() >> 4);
  return plane;
}

/// Widths whose rows are padded and are not, short and long, so that all ways of the writer are
/// taken; chunks begin and end within rows.
TEST(ChunkWriter, PlanesSurviveTheWayWithAndWithoutACopy) {
  for (const int width : {1, 37, 64, 160, 1000, 1024, 1030}) {
    const auto plane = std::make_shared<Plane>(noise(PlaneKind::kNormal, width, 700));
    for (const auto coding :
         {full_coding(PlaneKind::kNormal), PlaneCoding{PlaneFormat::kF32, Codec::kLz4}}) {
      Plane got(plane->id(), width, 700);
      ChunkWriter writer;
      ChunkReader reader;
      PlaneCoder coder;
      std::size_t offset = 0;
      do {
        OutgoingMessage message;
        const std::size_t next = writer.write(*plane, coding, 2, offset, plane, message);
        const ChunkView* const view = reader.read(message.bytes);
        ASSERT_NE(view, nullptr);
        EXPECT_EQ(view->fields.plane, 2u);
        EXPECT_EQ(view->fields.offset, offset);
        EXPECT_EQ(view->fields.last, next == 0);
        EXPECT_EQ(message.plane_bytes, view->data_bytes);
        const std::size_t held =
            coding.codec == Codec::kNone ? view->data_bytes : view->fields.plain_bytes;
        ASSERT_TRUE(coder.decode(got, coding, offset, held, view->data));
        offset = next;
      } while (offset != 0);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 700; ++y)
          for (int x = 0; x < width; ++x)
            ASSERT_EQ(got.words(c).at(x, y), plane->words(c).at(x, y)) << width;
    }
  }
}

TEST(ChunkWriter, KeepsThePlaneUntilItsMessageIsGone) {
  for (const int width : {64, 1024}) {
    auto plane = std::make_shared<Plane>(noise(PlaneKind::kDepth, width, 8));
    ASSERT_EQ(is_packed(*plane), width == 64);
    const std::weak_ptr<Plane> alive = plane;
    OutgoingMessage message;
    ChunkWriter().write(*plane, full_coding(PlaneKind::kDepth), 0, 0, plane, message);
    const float last = plane->channel(0).at(width - 1, 7);
    plane.reset();
    ASSERT_FALSE(alive.expired());
    const std::string bytes = text_of(message.bytes);
    EXPECT_EQ(bytes.substr(bytes.size() - 4), std::string(reinterpret_cast<const char*>(&last), 4));
    message = {};
    EXPECT_TRUE(alive.expired());
  }
}

TEST(ChunkWriter, RefersToRowsWherePaddingLiesBetweenThem) {
  const auto plane = std::make_shared<Plane>(noise(PlaneKind::kDepth, 1920, 300));
  ASSERT_FALSE(is_packed(*plane));
  ChunkWriter writer;
  OutgoingMessage message;
  std::size_t offset = 0, rows = 0;
  do {
    offset = writer.write(*plane, full_coding(PlaneKind::kDepth), 0, offset, plane, message);
    std::vector<grpc::Slice> slices;
    ASSERT_TRUE(message.bytes.Dump(&slices).ok());
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(plane->words(0).row(0));
    for (const grpc::Slice& slice : slices) {
      if (slice.size() < 64) continue;  // the fields of the chunk, an end of a row
      EXPECT_TRUE(slice.begin() >= begin && slice.end() <= begin + plane->bytes());
      rows += slice.size() == 1920 * sizeof(float);
    }
  } while (offset != 0);
  EXPECT_GE(rows, 296u) << "all but those that two chunks share";
}

}  // namespace
}  // namespace holdfast::wire
