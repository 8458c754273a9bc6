// Encrypted connections. The keys in tests/service/tls are for these tests only.
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast {
namespace {

using client::ConnectionError;
using client::Session;

std::string pem(const char* name) {
  return std::string(HOLDFAST_SOURCE "/tests/service/tls/") + name;
}

class Tls : public ::testing::Test {
 protected:
  void start() {
    server = std::make_unique<server::Server>(config);
    options = test::session_options(*server, frames);
    options.tls.ca = pem("ca.pem");
    options.connect_timeout = std::chrono::milliseconds(3000);
  }
  bool connects() const try {
    Session session(options);
    session.submit(test::small_frame(frames, 0));
    return !session.receive()->error;
  } catch (const ConnectionError&) {
    return false;
  }

  server::ServerConfig config = [] {
    server::ServerConfig out = test::server_config(1);
    out.tls.certificate = pem("server.pem");
    out.tls.key = pem("server.key");
    return out;
  }();
  const DenoiserConfig frames = test::small_config();
  client::SessionOptions options;
  std::unique_ptr<server::Server> server;
};

TEST_F(Tls, CarriesFramesOfAClientThatKnowsTheAuthority) {
  start();
  EXPECT_TRUE(connects());
}

TEST_F(Tls, RefusesAClientWithoutEncryption) {
  start();
  options.tls.ca.clear();
  EXPECT_FALSE(connects());
}

TEST_F(Tls, IsRefusedByAClientThatKnowsAnotherAuthority) {
  start();
  options.tls.ca = pem("server.pem");  // a certificate, but not of the authority
  config.tls.certificate = pem("client.pem");
  config.tls.key = pem("client.key");
  server = std::make_unique<server::Server>(config);
  options.address = server->address();
  EXPECT_FALSE(connects());
}

TEST_F(Tls, AsksForTheCertificateOfAClientWhereToldTo) {
  config.tls.client_ca = pem("ca.pem");
  start();
  EXPECT_FALSE(connects());
  options.tls.certificate = pem("client.pem");
  options.tls.key = pem("client.key");
  EXPECT_TRUE(connects());
}

TEST_F(Tls, ChecksTheNameThatItIsGivenInsteadOfThatOfTheAddress) {
  start();  // at 127.0.0.1, with a certificate for that and for localhost
  options.tls.server_name = "localhost";
  EXPECT_TRUE(connects());
  options.tls.server_name = "render.example";
  EXPECT_FALSE(connects());
}

TEST_F(Tls, NamesAFileThatIsNotThere) {
  start();
  options.tls.ca = "/nowhere/ca.pem";
  EXPECT_THROW(Session session(options), InputError);
}

TEST_F(Tls, ShowsARenewedCertificateToNewConnectionsWithoutARestart) {
  const test::SocketAddress place;
  config.tls.certificate = (place.directory() / "cert.pem").string();
  config.tls.key = (place.directory() / "key.pem").string();
  // Each file is replaced in one step, as those who renew certificates do.
  const auto install = [&](const std::string& name) {
    for (const auto& [file, target] : {std::pair(pem((name + ".key").c_str()), config.tls.key),
                                       {pem((name + ".pem").c_str()), config.tls.certificate}}) {
      std::filesystem::copy_file(file, target + ".new");
      std::filesystem::rename(target + ".new", target);
    }
  };
  // Whether a new connection finds, after some time, the certificate of that authority.
  const auto shows = [&](const char* authority) {
    options.tls.ca = pem(authority);
    for (int i = 0; i < 40; ++i) {
      if (connects()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    return false;
  };
  install("server");
  start();
  ASSERT_TRUE(connects());
  Session open(options);
  install("other");  // which is its own authority
  EXPECT_TRUE(shows("other.pem"));
  options.tls.ca = pem("ca.pem");
  EXPECT_FALSE(connects()) << "the old certificate is not shown any more";
  install("server");
  EXPECT_TRUE(shows("ca.pem"));
  open.submit(test::small_frame(frames, 0));
  EXPECT_FALSE(open.receive()->error) << "a connection that is open stays as it is";
  EXPECT_EQ(open.reconnects(), 0);
}

TEST(BearerToken, OfTheClientLibraryAdmits) {
  const test::SocketAddress place;
  server::ServerConfig config = test::server_config(1);
  config.token_file = (place.directory() / "tokens").string();
  std::ofstream(config.token_file) << "secret\n";
  const server::Server server(config);
  client::SessionOptions options = test::session_options(server, test::small_config());
  EXPECT_THROW(Session session(options), client::RefusedError);
  options.bearer_token = "secret";
  EXPECT_NO_THROW(Session session(options));
}

}  // namespace
}  // namespace holdfast
