#include "proto/shared_cells.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <system_error>

#include <gtest/gtest.h>

#include "core/frame/error.h"
#include "proto/chunk_writer.h"
#include "proto/wire_profile.h"

namespace holdfast::wire {
namespace {

Descriptor unsealed(std::size_t bytes, int seals = 0) {
  Descriptor made(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  EXPECT_EQ(ftruncate(made.get(), static_cast<off_t>(bytes)), 0);
  if (seals != 0) {
    EXPECT_EQ(fcntl(made.get(), F_ADD_SEALS, seals), 0);
  }
  return made;
}

TEST(SharedMemory, IsSeenByBothEndsAndNeitherCanTakeItsPagesAway) {
  const auto made = SharedMemory::make();
  const auto mapped = SharedMemory::map(made->descriptor(), made->layout());
  std::memcpy(mapped->cell(SharedPart::kInput, 3), "input", 5);
  std::memcpy(made->cell(SharedPart::kResults, 0), "results", 7);
  EXPECT_EQ(std::memcmp(made->cell(SharedPart::kInput, 3), "input", 5), 0);
  EXPECT_EQ(std::memcmp(mapped->cell(SharedPart::kResults, 0), "results", 7), 0);
  EXPECT_EQ(made->cell(SharedPart::kInput, 5), made->cell(SharedPart::kInput, 1)) << "in turn";
  const off_t bytes = static_cast<off_t>(made->layout().bytes());
  EXPECT_EQ(ftruncate(made->descriptor(), 0), -1);
  EXPECT_EQ(ftruncate(made->descriptor(), bytes + 4096), -1);
  EXPECT_EQ(fcntl(made->descriptor(), F_ADD_SEALS, F_SEAL_WRITE), -1);
}

TEST(SharedMemory, ThatMightShrinkOrIsOfAnotherSizeIsNotMapped) {
  const SharedLayout layout;
  const auto refused = [&](const Descriptor& memory, const SharedLayout& told) {
    EXPECT_THROW(SharedMemory::map(memory.get(), told), std::runtime_error);
  };
  refused(unsealed(layout.bytes()), layout);
  refused(unsealed(layout.bytes(), F_SEAL_GROW), layout);
  refused(unsealed(layout.bytes() - 1, F_SEAL_SHRINK), layout);
  refused(unsealed(0, F_SEAL_SHRINK), {0, kMaxChunkBytes});
  refused(unsealed(8192, F_SEAL_SHRINK), {1, 4096});
  refused(Descriptor(open("/dev/null", O_RDWR | O_CLOEXEC)), layout);
  refused(Descriptor(), layout);
  EXPECT_NO_THROW(SharedMemory::map(unsealed(layout.bytes(), F_SEAL_SHRINK).get(), layout));
}

TEST(SharedMemory, WhoHasMadeItGivesItsPagesBackWhoeverMapsIt) {
  const auto made = SharedMemory::make();
  const auto mapped = SharedMemory::map(made->descriptor(), made->layout());
  std::memset(mapped->cell(SharedPart::kInput, 0), 1, 10);
  std::memset(mapped->cell(SharedPart::kResults, 0), 2, 10);
  made->discard(SharedPart::kInput);
  EXPECT_EQ(*mapped->cell(SharedPart::kInput, 0), std::byte{0});
  EXPECT_EQ(*mapped->cell(SharedPart::kResults, 0), std::byte{2});
}

TEST(SharedCells, AreWrittenAgainOnlyAfterTheyWereRead) {
  const auto memory = SharedMemory::make();
  SharedCells client(memory, SharedPart::kInput), server(memory, SharedPart::kResults);
  const std::size_t cells = memory->layout().cells;
  for (std::uint64_t round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < cells; ++i) {
      ASSERT_FALSE(client.writer.full());
      std::memset(client.writer.cell(), static_cast<int>(round * cells + i), 8);
      client.writer.advance();
    }
    EXPECT_TRUE(client.writer.full());
    std::uint64_t told = round * cells;
    for (std::size_t i = 0; i < cells; ++i) {
      const std::string_view piece = server.reader.take(8);
      EXPECT_EQ(piece, std::string(8, static_cast<char>(round * cells + i)));
      if (const auto read = server.reader.due()) client.writer.note_read(told = *read);
    }
    EXPECT_EQ(told, (round + 1) * cells) << "who waits for a cell is told";
    EXPECT_TRUE(client.writer.all_read());
  }
}

TEST(SharedCells, RefuseCountsThatCannotBe) {
  const auto memory = SharedMemory::make();
  CellWriter writer(memory, SharedPart::kInput);
  for (int i = 0; i < 3; ++i) writer.advance();
  writer.note_read(2);
  for (const std::uint64_t bad : {std::uint64_t{1}, std::uint64_t{4}, ~std::uint64_t{0}})
    EXPECT_THROW(writer.note_read(bad), InputError) << bad;
  writer.note_read(3);
}

TEST(SharedCells, ChunksThatBreakARuleAreRefusedByName) {
  const auto memory = SharedMemory::make();
  CellReader reader(memory, SharedPart::kInput);
  const auto text = [&](std::uint32_t bytes, std::string_view data, CellReader* cells) {
    ChunkView chunk{{0, 0, false, 0, bytes}, {data}, data.size(), false};
    try {
      find_shared(chunk, cells);
    } catch (const InputError& error) {
      EXPECT_FALSE(chunk.shared);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(text(5, "", nullptr),
            "shared_bytes of a chunk must be 0 in a stream without shared memory, but it is 5");
  EXPECT_EQ(text(kMaxChunkBytes + 1, "", &reader),
            "shared_bytes of a chunk must be at most 1048576, but it is 1048577");
  EXPECT_EQ(text(0xffffffffu, "", &reader),
            "shared_bytes of a chunk must be at most 1048576, but it is 4294967295");
  EXPECT_EQ(text(8, "abc", &reader),
            "data of a chunk in shared memory must be empty, but it is 3 bytes");
  EXPECT_EQ(text(kMaxChunkBytes, "", &reader), "");
  EXPECT_EQ(text(0, "abc", &reader), "") << "in the stream";
}

/// A plane's chunks by a writer, with cells or without.
TEST(SharedCells, HoldTheBytesThatTheMessageWouldHold) {
  const auto memory = SharedMemory::make();
  for (const int width : {512, 515})
    for (const PlaneCoding coding :
         {full_coding(PlaneKind::kNormal), PlaneCoding{PlaneFormat::kF16, Codec::kNone},
          PlaneCoding{PlaneFormat::kF32, Codec::kLz4},
          PlaneCoding{PlaneFormat::kF16, Codec::kZstd}}) {
      CellWriter cells(memory, SharedPart::kInput);
      CellReader reader(memory, SharedPart::kInput);
      const auto plane = std::make_shared<Plane>(PlaneId{PlaneKind::kNormal, {}}, width, 400);
      for (int c = 0; c < 3; ++c)
        for (int y = 0; y < 400; ++y)
          for (int x = 0; x < width; ++x)
            plane->channel(c).at(x, y) = static_cast<float>((x * y + c) % 17) / 16;
      ChunkWriter plain, shared;
      shared.use(&cells);
      ChunkReader plain_reader, shared_reader;
      std::size_t offset = 0;
      do {
        OutgoingMessage a, b;
        const std::size_t next = plain.write(*plane, coding, 1, offset, plane, a);
        ASSERT_EQ(shared.write(*plane, coding, 1, offset, plane, b), next);
        EXPECT_EQ(a.plane_bytes, b.plane_bytes);
        EXPECT_EQ(a.shared_bytes, 0u);
        EXPECT_EQ(b.shared_bytes, b.plane_bytes);
        const ChunkView* const by_message = plain_reader.read(a.bytes);
        ChunkView* const by_cell = shared_reader.read(b.bytes);
        ASSERT_TRUE(by_message && by_cell);
        EXPECT_EQ(by_cell->data_bytes, 0u);
        find_shared(*by_cell, &reader);
        EXPECT_TRUE(by_cell->shared);
        std::string joined;
        for (const std::string_view piece : by_message->data) joined += piece;
        ASSERT_TRUE(joined == by_cell->data.at(0)) << "at " << offset;
        if (const auto read = reader.due()) cells.note_read(*read);
        offset = next;
      } while (offset != 0);
    }
}

TEST(SharedCells, WithoutAFreeOneThePieceTravelsInItsMessage) {
  const auto memory = SharedMemory::make();
  CellWriter cells(memory, SharedPart::kInput);
  ChunkWriter writer;
  writer.use(&cells);
  const auto plane = std::make_shared<Plane>(PlaneId{PlaneKind::kDepth, {}}, 64, 8);
  OutgoingMessage message;
  for (std::size_t i = 0; i < memory->layout().cells; ++i) {
    writer.write(*plane, full_coding(PlaneKind::kDepth), 0, 0, plane, message);
    EXPECT_EQ(message.shared_bytes, 2048u);
  }
  writer.write(*plane, full_coding(PlaneKind::kDepth), 0, 0, plane, message);
  EXPECT_EQ(message.shared_bytes, 0u);
  EXPECT_EQ(message.plane_bytes, 2048u);
}

}  // namespace
}  // namespace holdfast::wire
