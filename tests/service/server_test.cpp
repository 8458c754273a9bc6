#include "server/server.h"

#include <filesystem>

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "core/frame/error.h"
#include "server/embedded.h"
#include "server/listen_address.h"
#include "tests/service/raw_client.h"

namespace holdfast::server {
namespace {

ServerConfig config_at(const std::string& address) {
  ServerConfig config;
  config.listen = address;
  config.threads = 1;
  config.log_level = "off";
  return config;
}

std::string error_of(const ServerConfig& config) {
  try {
    const Server server(config);
  } catch (const InputError& error) {
    return error.what();
  }
  return "started";
}

/// Sends one message, given as its bytes, and returns the bytes of the first answer.
std::string call(const std::string& address, const std::string& method,
                 const std::string& request) {
  const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  grpc::GenericStub stub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  grpc::CompletionQueue queue;
  const auto wait = [&] {
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
  };
  const grpc::Slice slice(request);
  const grpc::ByteBuffer message(&slice, 1);
  grpc::ByteBuffer answer;
  grpc::Status status;
  {
    const auto stream = stub.PrepareCall(&context, method, &queue);
    stream->StartCall(nullptr);
    wait();
    stream->Write(message, nullptr);
    wait();
    stream->WritesDone(nullptr);
    wait();
    stream->Read(&answer, nullptr);
    wait();
    stream->Finish(&status, nullptr);
    wait();
  }
  std::vector<grpc::Slice> slices;
  answer.Dump(&slices);
  std::string bytes;
  for (const grpc::Slice& s : slices)
    bytes.append(reinterpret_cast<const char*>(s.begin()), s.size());
  return bytes;
}

TEST(Server, SaysThatItIsHealthy) {
  const Server server(config_at("127.0.0.1:0"));
  EXPECT_EQ(call(server.address(), "/grpc.health.v1.Health/Check", ""),
            "\x08\x01")  // HealthCheckResponse{status: SERVING}
      << "health";
}

TEST(Server, SaysThatItIsNotServingOnceItDrains) {
  Server server(config_at("127.0.0.1:0"));
  server.drain(std::chrono::milliseconds(0));
  EXPECT_EQ(call(server.address(), "/grpc.health.v1.Health/Check", ""),
            "\x08\x02");  // NOT_SERVING
}

TEST(Server, ListsItsServicesByReflection) {
  const Server server(config_at("127.0.0.1:0"));
  const std::string answer =
      call(server.address(), "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
           "\x3a\x01*");  // ServerReflectionRequest{list_services: "*"}
  EXPECT_NE(answer.find("holdfast.v1.SessionService"), std::string::npos);
  EXPECT_NE(answer.find("holdfast.v1.DenoiseService"), std::string::npos);
}

TEST(Server, SaysWhatItCanDo) {
  const Server server(config_at("127.0.0.1:0"));
  test::RawClient client(server.address());
  v1::GetServerInfoResponse info;
  grpc::ClientContext context;
  ASSERT_TRUE(client.sessions->GetServerInfo(&context, {}, &info).ok());
  EXPECT_EQ(info.recipes_size(), static_cast<int>(recipe_names().size()));
  ASSERT_EQ(info.wires_size(), 3);
  EXPECT_EQ(info.wires(0), "exact");
  EXPECT_EQ(info.wires(2), "compact");
  EXPECT_EQ(info.threads(), 1u);
  EXPECT_EQ(info.max_chunk_bytes(), 1u << 20);
}

TEST(Server, NamesAnAddressInUse) {
  const Server first(config_at("127.0.0.1:0"));
  EXPECT_EQ(error_of(config_at(first.address())),
            "listen address " + first.address() +
                " must be free, but it is in use: another program listens there");
}

TEST(Server, NamesASocketFileInUseAndLeavesItAlone) {
  const EmbeddedServer first(1);
  const std::string message = error_of(config_at(first.address()));
  EXPECT_NE(message.find("in use: another server listens there"), std::string::npos) << message;
  test::RawClient client(first.address());
  EXPECT_TRUE(client.create(test::small_config()).ok());
}

TEST(Server, NamesABadAddress) {
  EXPECT_EQ(error_of(config_at("nonsense")),
            "listen address nonsense must be host:port or unix:PATH, but it is \"nonsense\"");
  EXPECT_EQ(error_of(config_at("127.0.0.1:70000")),
            "listen address 127.0.0.1:70000 must have a port in 0..65535, but it is \"70000\"");
  EXPECT_EQ(error_of(config_at("unix:")),
            "listen address unix: must have a path of 1..107 bytes, but it is 0 bytes");
}

TEST(Server, NamesABadLogLevel) {
  ServerConfig config = config_at("127.0.0.1:0");
  config.log_level = "loud";
  EXPECT_EQ(error_of(config),
            "log level must be one of trace, debug, info, warn, error, off, but it is \"loud\"");
}

TEST(Server, KnowsLocalAddresses) {
  EXPECT_TRUE(is_local_address("127.0.0.1:1"));
  EXPECT_TRUE(is_local_address("[::1]:1"));
  EXPECT_TRUE(is_local_address("unix:/tmp/x"));
  EXPECT_FALSE(is_local_address("0.0.0.0:1"));
}

TEST(EmbeddedServer, RemovesItsSocket) {
  std::filesystem::path socket;
  {
    const EmbeddedServer server(1);
    socket = server.address().substr(5);
    EXPECT_TRUE(std::filesystem::exists(socket));
  }
  EXPECT_FALSE(std::filesystem::exists(socket.parent_path()));
}

}  // namespace
}  // namespace holdfast::server
