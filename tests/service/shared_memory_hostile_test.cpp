// Clients that share memory with the server and keep to no rule.
#include <atomic>
#include <cstring>
#include <random>
#include <thread>

#include "client/sdk/shared_memory.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::RawClient;
using test::RawStream;

/// A generated client with shared memory.
class HostileSharer : public ::testing::Test {
 protected:
  HostileSharer() {
    server::ServerConfig at = test::server_config(2);
    at.listen = directory.address();
    at.shared_memory = (directory.directory() / "memory").string();
    server = std::make_unique<server::Server>(at);
    client = std::make_unique<RawClient>(server->address());
    client::SessionOptions options = test::session_options(*server, config);
    options.shared_memory = at.shared_memory;
    v1::CreateSessionRequest request;
    client::write_create_request(options, request);
    grpc::ClientContext context;
    EXPECT_TRUE(client->sessions->CreateSession(&context, request, &client->session).ok());
    offer = client::ask_for_shared_memory(at.shared_memory, client->session.session_id(),
                                          client->session.token());
    EXPECT_TRUE(offer.memory);
    cells.emplace(offer.memory, wire::SharedPart::kInput);
  }

  /// Hello and Welcome.
  bool attach(RawStream& stream) const {
    v1::DenoiseRequest hello;
    hello.mutable_hello()->set_session_id(client->session.session_id());
    hello.mutable_hello()->set_token(client->session.token());
    hello.mutable_hello()->set_shared_memory(offer.name);
    stream.write(hello);
    return stream.read().welcome().shared_memory();
  }
  /// Moves the data of a chunk to the next cell, whether or not it was read.
  void share(v1::DenoiseRequest& message) {
    if (!message.has_plane_chunk()) return;
    v1::PlaneChunk& chunk = *message.mutable_plane_chunk();
    std::memcpy(cells->writer.cell(), chunk.data().data(), chunk.data().size());
    cells->writer.advance();
    chunk.set_shared_bytes(static_cast<std::uint32_t>(chunk.data().size()));
    chunk.clear_data();
  }
  std::vector<v1::DenoiseRequest> shared_messages(int index, const char* wire = "exact") {
    auto messages = RawStream::messages(test::small_frame(config, index), config, wire);
    for (v1::DenoiseRequest& message : messages) share(message);
    return messages;
  }
  /// The next FrameResult and its planes; SharedRead of the server are read over.
  v1::FrameResult result(RawStream& stream) {
    for (;;) {
      const v1::DenoiseResponse response = stream.read();
      if (response.has_plane_chunk() || response.has_shared_read()) continue;
      return response.frame_result();
    }
  }

  const test::SocketAddress directory;
  DenoiserConfig config = test::small_config();
  std::unique_ptr<server::Server> server;
  std::unique_ptr<RawClient> client;
  client::SharedMemoryOffer offer;
  std::optional<wire::SharedCells> cells;
};

TEST_F(HostileSharer, BadSizesFailTheirFrameAloneAndHistoryGoesOn) {
  RawStream stream(*client);
  ASSERT_TRUE(attach(stream));
  for (const auto& message : shared_messages(0)) stream.write(message);
  ASSERT_FALSE(result(stream).has_error());
  const auto fails = [&](std::uint32_t bytes, const std::string& data, const std::string& value) {
    auto messages = shared_messages(1);
    messages[1].mutable_plane_chunk()->set_shared_bytes(bytes);
    messages[1].mutable_plane_chunk()->set_data(data);
    for (const auto& message : messages) stream.write(message);
    const v1::FrameResult bad = result(stream);
    EXPECT_EQ(bad.error().code(), v1::FRAME_ERROR_CODE_INVALID_FRAME);
    EXPECT_EQ(bad.error().violation().value(), value);
  };
  fails(wire::kMaxChunkBytes + 1, "", "1048577");
  fails(0xffffffffu, "", "4294967295");
  fails(3, "", "3 bytes");                        // no whole element
  fails(1u << 20, "", "at least 1048576 bytes");  // more than the plane
  fails(8, "data too", "8 bytes");
  fails(0, "", "0 bytes");  // neither
  for (const auto& message : shared_messages(1)) stream.write(message);
  const v1::FrameResult next = result(stream);
  EXPECT_FALSE(next.has_error()) << next.error().message();
  EXPECT_FALSE(next.history_reset());
}

TEST_F(HostileSharer, WithoutSharedMemoryItsChunksAreRefusedByName) {
  RawStream stream(*client);
  offer.name = "another";
  ASSERT_FALSE(attach(stream));
  for (const auto& message : shared_messages(0)) stream.write(message);
  const v1::FrameResult bad = result(stream);
  EXPECT_EQ(bad.error().message(),
            "shared_bytes of a chunk must be 0 in a stream without shared memory, but it is 3108");
  for (const auto& message : RawStream::messages(test::small_frame(config, 0), config))
    stream.write(message);
  EXPECT_FALSE(result(stream).has_error());
  v1::DenoiseRequest read;
  read.mutable_shared_read()->set_cells(0);
  stream.write(read);
  while (stream.read().has_plane_chunk()) {
  }
  EXPECT_EQ(stream.finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(HostileSharer, CountsThatCannotBeEndTheStreamAndNotTheSession) {
  for (const std::uint64_t count : {std::uint64_t{1}, ~std::uint64_t{0}}) {
    RawStream stream(*client);
    offer = client::ask_for_shared_memory((directory.directory() / "memory").string(),
                                          client->session.session_id(), client->session.token());
    ASSERT_TRUE(attach(stream));
    v1::DenoiseRequest read;
    read.mutable_shared_read()->set_cells(count);
    stream.write(read);
    const grpc::Status status = stream.finish();
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_NE(status.error_message().find("cells of SharedRead must be in 0..0"),
              std::string::npos);
  }
  EXPECT_FALSE(client->get().streaming());
}

TEST_F(HostileSharer, ThatNeverTellsWhatItHasReadGetsTheRestThroughTheStream) {
  RawStream stream(*client);
  ASSERT_TRUE(attach(stream));
  for (int i = 0; i < 3; ++i)
    for (const auto& message : shared_messages(i)) stream.write(message);
  stream.writes_done();
  wire::CellReader& results = cells->reader;
  int answers = 0, shared = 0, inside = 0;
  for (;;) {
    v1::DenoiseResponse response = stream.read();
    if (response.message_case() == v1::DenoiseResponse::MESSAGE_NOT_SET) break;
    if (response.has_frame_result()) ++answers;
    if (!response.has_plane_chunk()) continue;
    if (response.plane_chunk().shared_bytes() > 0)
      results.take(response.plane_chunk().shared_bytes()), ++shared;
    else
      ++inside;
  }
  EXPECT_TRUE(stream.finish().ok());
  EXPECT_EQ(answers, 3);
  EXPECT_EQ(shared, static_cast<int>(wire::SharedLayout{}.cells));
  EXPECT_GT(inside, 0);
}

// It tells of a cell when all are full and the server, which waits for one, has nothing else to
// say; and of one only.
TEST_F(HostileSharer, ThatTellsAtTheLastMomentGetsEachPieceWhole) {
  std::vector<Frame> frames;
  for (int i = 0; i < 3; ++i) frames.push_back(test::small_frame(config, i));
  const std::vector<PlaneSet> expected = test::direct(config, frames);
  RawStream stream(*client);
  ASSERT_TRUE(attach(stream));
  const std::vector<PlaneId> results = result_planes(config);
  std::uint64_t read = 0, told = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    stream.write(frames[i], config);
    ASSERT_FALSE(result(stream).has_error());
    for (std::size_t pieces = 0; pieces < results.size();) {
      const v1::DenoiseResponse response = stream.read();
      if (response.has_shared_read()) continue;
      const v1::PlaneChunk& chunk = response.plane_chunk();
      ASSERT_TRUE(chunk.last() && chunk.data().empty()) << "all small, and all shared";
      const Plane& plane = expected[i].at(results[chunk.plane()]);
      std::string bytes(wire::plane_bytes(plane, wire::PlaneFormat::kF32), ' ');
      wire::read_plane_bytes(plane, wire::PlaneFormat::kF32, 0, bytes.size(),
                             reinterpret_cast<std::byte*>(bytes.data()));
      EXPECT_TRUE(cells->reader.take(chunk.shared_bytes()) == bytes);
      ++pieces;
      if (++read - told < wire::SharedLayout{}.cells) continue;
      v1::DenoiseRequest message;
      message.mutable_shared_read()->set_cells(++told);
      stream.write(message);
    }
  }
  EXPECT_GT(told, 0u) << "the server has waited";
  stream.writes_done();
  EXPECT_TRUE(stream.finish().ok());
}

TEST_F(HostileSharer, ThatFloodsWithoutReadingIsToldOnceAndCostsNoMemory) {
  RawStream stream(*client);
  ASSERT_TRUE(attach(stream));
  auto messages = shared_messages(0);
  stream.write(messages[0]);
  messages[1].mutable_plane_chunk()->set_shared_bytes(3);  // the frame is bad from here on
  for (int i = 0; i < 5000; ++i) stream.write(messages[1]);
  stream.write(messages.back());
  std::uint64_t told = 0;
  for (;;) {
    const v1::DenoiseResponse response = stream.read();
    if (response.has_shared_read()) {
      EXPECT_GT(response.shared_read().cells(), told);
      told = response.shared_read().cells();
      continue;
    }
    EXPECT_TRUE(response.frame_result().has_error());
    break;
  }
  EXPECT_EQ(told, 5000u);
}

TEST_F(HostileSharer, ScribblingWhileTheServerDecodesHarmsNobodyElse) {
  config = test::small_config(320, 240);
  for (const char* wire : {"compact", "balanced", "exact"}) {
    client = std::make_unique<RawClient>(server->address());
    client::SessionOptions options = test::session_options(*server, config);
    options.shared_memory = (directory.directory() / "memory").string();
    options.wire = wire;
    v1::CreateSessionRequest request;
    client::write_create_request(options, request);
    grpc::ClientContext context;
    ASSERT_TRUE(client->sessions->CreateSession(&context, request, &client->session).ok());
    offer = client::ask_for_shared_memory(options.shared_memory, client->session.session_id(),
                                          client->session.token());
    ASSERT_TRUE(offer.memory);
    cells.emplace(offer.memory, wire::SharedPart::kInput);
    std::atomic<bool> stop = false;
    std::thread scribbler([&] {
      std::mt19937 random(1);
      while (!stop)
        for (int i = 0; i < 64; ++i) {
          const auto part = i % 2 ? wire::SharedPart::kInput : wire::SharedPart::kResults;
          *(offer.memory->cell(part, random() % 4) + random() % 3000) =
              static_cast<std::byte>(random());
        }
    });
    RawStream stream(*client);
    ASSERT_TRUE(attach(stream));
    std::thread writer([&] {
      for (int i = 0; i < 20; ++i)
        for (const auto& message : shared_messages(i, wire)) stream.write(message);
      stream.writes_done();
    });
    std::vector<Frame> frames;
    for (int i = 0; i < 4; ++i) frames.push_back(test::small_frame(config, i));
    options.wire = "exact";
    test::expect_same(test::served(options, frames), test::direct(config, frames));
    int answers = 0;
    for (;;) {
      const v1::DenoiseResponse response = stream.read();
      if (response.message_case() == v1::DenoiseResponse::MESSAGE_NOT_SET) break;
      if (response.has_frame_result()) ++answers;
    }
    writer.join();
    stop = true;
    scribbler.join();
    EXPECT_TRUE(stream.finish().ok());
    EXPECT_EQ(answers, 20) << "good or bad, each is answered";
  }
}

}  // namespace
}  // namespace holdfast
