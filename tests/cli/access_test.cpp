// Encrypted and guarded servers, as a user meets them. The keys in tests/service/tls are for tests
// only.
#include "tests/cli/program_test.h"

namespace holdfast {
namespace {

std::string pem(const char* name) {
  return std::string(HOLDFAST_SOURCE "/tests/service/tls/") + name;
}

class Access : public test::ProgramTest {
 protected:
  /// Starts a server with TLS on a free port.
  void serve(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {HOLDFAST_SERVER_PROGRAM, "--listen", "127.0.0.1:0", "--threads", "1",
                               "--tls-cert", pem("server.pem"), "--tls-key", pem("server.key")});
    server = std::make_unique<test::Program>(more, dir / "server");
    ASSERT_TRUE(server->wait_for("event=listening")) << server->text();
    address = server->printed("address=");
  }
  int load(std::vector<std::string> more) {
    more.insert(more.begin(), {"load", "--size", "16x12", "--seconds", "0.2", "--fps", "10",
                               "--server", address});
    return holdfast(more);
  }
  std::string file(const std::string& name, const std::string& content) const {
    std::ofstream(dir / name) << content;
    return path(name);
  }

  std::unique_ptr<test::Program> server;
  std::string address;
};

TEST_F(Access, LoadAndReplayReachAServerThatAsksForACertificateAndAToken) {
  const std::string tokens = file("tokens", "# of the tests\nopen-sesame\n");
  serve({"--tls-client-ca", pem("ca.pem"), "--token-file", tokens});
  const std::vector<std::string> access{"--tls-ca",        pem("ca.pem"), "--tls-cert",
                                        pem("client.pem"), "--tls-key",   pem("client.key"),
                                        "--token-file",    tokens};
  EXPECT_EQ(load(access), 0) << text;
  EXPECT_NE(text.find("answered 2 of 2"), std::string::npos) << text;
  std::vector<std::string> far = access;
  far.insert(far.end(), {"--delay-ms", "5"});
  EXPECT_EQ(load(far), 0) << "encryption passes through the link: " << text;
  render("fence", {"--frames", "2", "--reference-spp", "0"});
  std::vector<std::string> replay{"replay",  path("in"), "-o",   path("out"),
                                  "--quiet", "--server", address};
  replay.insert(replay.end(), access.begin(), access.end());
  EXPECT_EQ(holdfast(replay), 0) << text;
  EXPECT_TRUE(std::filesystem::exists(dir / "out" / "frame.0001.exr"));
}

TEST_F(Access, LoadAndReplaySayWhetherTheyGotTheSharedMemoryThatTheyAskedFor) {
  const std::string memory = path("memory"), result = path("result.json");
  serve({"--shared-memory", memory});
  render("fence", {"--frames", "2", "--reference-spp", "0"});
  for (const std::string& asked : {memory, path("elsewhere")}) {
    const bool got = asked == memory;
    const std::vector<std::string> access{"--tls-ca", pem("ca.pem"), "--shared-memory",
                                          asked,      "--json",      result};
    std::vector<std::string> more = access;
    more.insert(more.end(), {"--sessions", "2"});
    ASSERT_EQ(load(more), 0) << text;
    EXPECT_NE(text.find(got ? "shared memory: 2 of 2 clients\n"
                            : "shared memory: 0 of 2 clients; planes of the others went through"),
              std::string::npos)
        << text;
    auto json = nlohmann::json::parse(test::file_text(result), nullptr, false);
    EXPECT_EQ(json["shared_memory"], nlohmann::json({{"asked", true}, {"clients", got ? 2 : 0}}));

    more = {"replay", path("in"), "-o", path("out"), "--quiet", "--server", address};
    more.insert(more.end(), access.begin(), access.end());
    ASSERT_EQ(holdfast(more), 0) << text;
    EXPECT_EQ(text.find("no shared memory at") == std::string::npos, got) << text;
    json = nlohmann::json::parse(test::file_text(result), nullptr, false);
    EXPECT_EQ(json["shared_memory"], nlohmann::json({{"asked", true}, {"used", got}}));
  }
  ASSERT_EQ(load({"--tls-ca", pem("ca.pem"), "--json", result}), 0) << text;
  const auto json = nlohmann::json::parse(test::file_text(result), nullptr, false);
  EXPECT_FALSE(json.contains("shared_memory"));
  EXPECT_EQ(text.find("shared memory"), std::string::npos) << text;
}

TEST_F(Access, ThatIsRefusedEndsWithThree) {
  serve({"--token-file", file("tokens", "open-sesame\n")});
  EXPECT_EQ(load({"--tls-ca", pem("ca.pem")}), 3);
  EXPECT_NE(text.find("asks for a bearer token"), std::string::npos) << text;
  EXPECT_EQ(load({"--tls-ca", pem("ca.pem"), "--token-file", file("mine", "guess\n")}), 3);
  EXPECT_NE(text.find("token is not known"), std::string::npos) << text;
  EXPECT_EQ(text.find("guess"), std::string::npos) << "no message repeats a token";
  EXPECT_EQ(load({}), 3) << "without encryption";
}

TEST_F(Access, WithABadFileEndsWithTwoAndNamesIt) {
  address = "127.0.0.1:1";
  EXPECT_EQ(load({"--tls-ca", "/nowhere/ca.pem"}), 2);
  EXPECT_NE(text.find("TLS authorities /nowhere/ca.pem must be a file that can be read"),
            std::string::npos)
      << text;
  EXPECT_EQ(load({"--tls-ca", pem("server.key")}), 2);
  EXPECT_NE(text.find("must hold a CERTIFICATE in PEM form"), std::string::npos) << text;
  EXPECT_EQ(load({"--tls-ca", pem("ca.pem"), "--tls-cert", pem("client.pem"), "--tls-key",
                  pem("ca.pem")}),
            2);
  EXPECT_NE(text.find("must hold a PRIVATE KEY in PEM form"), std::string::npos) << text;
  EXPECT_EQ(load({"--tls-ca", pem("ca.pem"), "--tls-cert", pem("client.pem"), "--tls-key",
                  pem("server.key")}),
            3)
      << "the key of another certificate";
  EXPECT_NE(text.find("Invalid private key"), std::string::npos) << text;
  EXPECT_EQ(load({"--tls-ca", pem("ca.pem"), "--tls-cert", pem("client.pem")}), 2);
  EXPECT_EQ(load({"--token-file", "/nowhere/token"}), 2);
  EXPECT_NE(text.find("token file /nowhere/token"), std::string::npos) << text;
  EXPECT_EQ(load({"--token-file", file("empty", "# nothing\n")}), 2);
  EXPECT_NE(text.find("must hold a token"), std::string::npos) << text;
  EXPECT_EQ(load({"--token-file", file("odd", "two words\n")}), 2);
  EXPECT_NE(text.find("visible ASCII"), std::string::npos) << text;
  EXPECT_EQ(text.find("two words"), std::string::npos);
}

TEST_F(Access, GoesWithAServerOnly) { EXPECT_EQ(holdfast({"load", "--tls-ca", pem("ca.pem")}), 2); }

}  // namespace
}  // namespace holdfast
