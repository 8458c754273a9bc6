// What an operator sees: probes, metrics, limits, tokens, configuration.
#include <fstream>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "core/frame/error.h"
#include "server/options.h"
#include "tests/service/http_get.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

const char* const holdfast::test::kServerProgram = HOLDFAST_SERVER;

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using test::http;
using test::RawClient;
using test::RawStream;

class Operations : public ::testing::Test {
 protected:
  /// The admin port only where it is used: its threads take two seconds to end.
  void start(bool admin = false) {
    if (admin) config.admin = "127.0.0.1:0";
    server = std::make_unique<server::Server>(config);
  }
  std::string get(const std::string& path) { return http(server->admin_address(), "GET " + path); }
  /// The value of a metric without labels.
  double value(const std::string& name) {
    const std::string text = get("/metrics");
    const std::size_t at = text.find("\n" + name + " ");
    return at == std::string::npos ? -1 : std::stod(text.substr(at + name.size() + 2));
  }
  bool shows(const std::string& line) {
    return get("/metrics").find(line + "\n") != std::string::npos;
  }

  server::ServerConfig config = test::server_config(1);
  const DenoiserConfig frames = test::small_config();
  std::unique_ptr<server::Server> server;
};

TEST_F(Operations, ProbesSayWhetherTheServerLivesAndIsReady) {
  start(true);
  EXPECT_EQ(get("/healthz").find("HTTP/1.1 200"), 0u) << get("/healthz");
  EXPECT_EQ(get("/readyz").find("HTTP/1.1 200"), 0u);
  server->drain(0ms);
  EXPECT_EQ(get("/readyz").find("HTTP/1.1 503"), 0u);
  EXPECT_EQ(get("/healthz").find("HTTP/1.1 200"), 0u) << "it lives";
  EXPECT_TRUE(shows("holdfast_ready 0"));
}

TEST_F(Operations, AdminPortKnowsItsPagesOnly) {
  start(true);
  EXPECT_EQ(get("/etc/passwd").find("HTTP/1.1 404"), 0u);
  EXPECT_EQ(http(server->admin_address(), "POST /healthz").find("HTTP/1.1 405"), 0u);
}

TEST_F(Operations, MetricsCountFramesStagesResetsAndRefusals) {
  start(true);
  RawClient client(server->address());
  ASSERT_TRUE(client.create(frames).ok());
  RawStream stream(client);
  stream.attach();
  const auto pass = [&](int index, bool cut) {
    Frame frame = test::small_frame(frames, index);
    frame.cut = cut;
    stream.write(frame, frames);
    return stream.read_result();
  };
  pass(0, false);
  pass(1, false);
  pass(1, false);
  pass(2, true);
  EXPECT_TRUE(pass(0, false).repeated());
  EXPECT_TRUE(pass(-1, false).has_error());
  EXPECT_TRUE(shows("holdfast_frames_total{result=\"ok\"} 3")) << get("/metrics");
  EXPECT_TRUE(shows("holdfast_frames_total{result=\"repeated\"} 2"));
  EXPECT_TRUE(shows("holdfast_frames_total{result=\"invalid\"} 1"));
  EXPECT_TRUE(shows("holdfast_history_resets_total{reason=\"first\"} 1"));
  EXPECT_TRUE(shows("holdfast_history_resets_total{reason=\"cut\"} 1"));
  EXPECT_TRUE(shows("holdfast_stage_seconds_count{stage=\"filter\"} 3"));
  EXPECT_TRUE(shows("holdfast_stage_seconds_count{stage=\"receive\"} 6"));
  EXPECT_TRUE(shows("holdfast_stage_seconds_count{stage=\"decode\"} 6"));
  EXPECT_TRUE(shows("holdfast_stage_seconds_count{stage=\"encode\"} 5") ||
              shows("holdfast_stage_seconds_count{stage=\"encode\"} 6"))
      << "the last one may just be leaving";
  EXPECT_TRUE(shows("holdfast_preset_frames_total{preset=\"balanced\"} 3"));
  EXPECT_TRUE(shows("holdfast_preset_frames_total{preset=\"fast\"} 0")) << "from the start";
  EXPECT_FALSE(shows("holdfast_stage_seconds_sum{stage=\"decode\"} 0"));
  // Planes of 9 words a pixel come, of 4 go back; messages add a little.
  const double pixels = 37 * 21;
  EXPECT_NEAR(value("holdfast_received_bytes_total"), 6 * 36 * pixels, 6 * 1500);
  EXPECT_NEAR(value("holdfast_sent_bytes_total"), 5 * 16 * pixels, 6 * 1500);
  EXPECT_TRUE(shows("holdfast_sessions 1"));
  EXPECT_TRUE(shows("holdfast_streams 1"));
  RawStream wrong(client);
  wrong.hello(client.session.session_id(), "guess");
  wrong.finish();
  EXPECT_TRUE(shows("holdfast_refusals_total{reason=\"wrong_token\"} 1"));
  EXPECT_EQ(get("/metrics").find(client.session.session_id()), std::string::npos);
}

TEST_F(Operations, TheShareOfTimeThatIsAdmittedIsToldEverywhereAlike) {
  config.calibrate = true;
  config.limits.max_load = 0.6;
  start(true);
  client::SessionOptions options = test::session_options(*server, frames);
  const auto stub = v1::SessionService::NewStub(
      grpc::CreateChannel(server->address(), grpc::InsecureChannelCredentials()));
  const auto info = [&] {
    grpc::ClientContext context;
    v1::GetServerInfoResponse response;
    EXPECT_TRUE(stub->GetServerInfo(&context, {}, &response).ok());
    return response;
  };
  EXPECT_EQ(value("holdfast_load"), 0);
  EXPECT_EQ(info().load(), 0);
  EXPECT_DOUBLE_EQ(info().max_load(), 0.6);
  options.frames_per_second = 1;
  const client::Session first(options);
  const double one = info().load();
  EXPECT_GT(one, 0);
  const client::Session second(options);
  options.frames_per_second = 0;
  const client::Session silent(options);
  EXPECT_NEAR(info().load(), 2 * one, 1e-9 * one) << "who tells no rate has no share";
  EXPECT_NEAR(value("holdfast_load"), 2 * one, 1e-5 * one);
  const std::string page = get("/sessions.json");
  const auto json = nlohmann::json::parse(page.substr(page.find('{')));
  EXPECT_NEAR(json["load"].get<double>(), 2 * one, 1e-9 * one);
  EXPECT_DOUBLE_EQ(json["max_load"].get<double>(), 0.6);
}

TEST_F(Operations, RefusalForALimitNamesItAndWhenToComeBack) {
  config.limits.max_sessions = 1;
  start();
  RawClient client(server->address());
  ASSERT_TRUE(client.create(frames).ok());
  v1::CreateSessionRequest request;
  client::write_create_request(test::session_options(*server, frames), request);
  const auto refused = [&] {
    grpc::ClientContext context;
    v1::CreateSessionResponse response;
    EXPECT_EQ(client.sessions->CreateSession(&context, request, &response).error_code(),
              grpc::StatusCode::RESOURCE_EXHAUSTED);
    std::map<std::string, std::string> out;
    for (const auto& [key, value] : context.GetServerTrailingMetadata())
      out[{key.data(), key.size()}] = {value.data(), value.size()};
    return out;
  };
  EXPECT_EQ(refused()["holdfast-quota"], "max-sessions");
  EXPECT_EQ(refused()["holdfast-retry-after-ms"], "30000");
  config.limits.max_session_bytes = 1000;
  config.limits.max_sessions = 2;
  start();
  client.sessions = v1::SessionService::NewStub(
      grpc::CreateChannel(server->address(), grpc::InsecureChannelCredentials()));
  EXPECT_EQ(refused()["holdfast-quota"], "max-session-bytes");
  EXPECT_EQ(refused().count("holdfast-retry-after-ms"), 0u) << "it will never fit";
}

TEST_F(Operations, LimitsOfSizeAndStreamsAreKept) {
  config.limits.max_dimension = 36;
  config.max_streams = 1;
  start();
  RawClient client(server->address());
  EXPECT_EQ(client.create(frames).error_message(),
            "size of a frame must be at most 36 pixels on each side on this server, but it is "
            "37x21");
  const DenoiserConfig small = test::small_config(36, 21);
  ASSERT_TRUE(client.create(small).ok());
  RawStream first(client);
  first.attach();
  RawStream second(client);
  EXPECT_EQ(second.finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

TEST_F(Operations, SessionsNeedATokenOfTheFileAndTheFileMayChange) {
  const test::SocketAddress place;
  config.token_file = (place.directory() / "tokens").string();
  std::ofstream(config.token_file) << "# of the render farm\nfirst-token\n";
  start();
  RawClient client(server->address());
  v1::CreateSessionRequest request;
  client::write_create_request(test::session_options(*server, frames), request);
  const auto create = [&](const std::string& token) {
    grpc::ClientContext context;
    if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
    v1::CreateSessionResponse response;
    return client.sessions->CreateSession(&context, request, &response);
  };
  EXPECT_TRUE(create("first-token").ok());
  EXPECT_EQ(create("").error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(create("# of the render farm").error_code(), grpc::StatusCode::UNAUTHENTICATED);
  const grpc::Status wrong = create("second-token");
  EXPECT_EQ(wrong.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(wrong.error_message().find("second-token"), std::string::npos);
  std::this_thread::sleep_for(20ms);  // so that the file's time differs
  std::ofstream(config.token_file) << "second-token\n";
  EXPECT_TRUE(create("second-token").ok());
  EXPECT_FALSE(create("first-token").ok());
}

// --- configuration -------------------------------------------------------------------------------

std::string refusal(const server::ServerConfig& config) {
  try {
    server::check_config(config);
  } catch (const InputError& error) {
    return error.what();
  }
  return "good";
}

TEST(Configuration, RefusesAddressesBeyondThisMachineUnlessAllowed) {
  server::ServerConfig config;
  config.listen = "0.0.0.0:50051";
  EXPECT_NE(refusal(config).find("unless --allow-remote is given"), std::string::npos);
  config.allow_remote = true;
  EXPECT_EQ(refusal(config), "good");
  config.allow_remote = false;
  config.listen = "127.0.0.1:50051";
  config.admin = "192.0.2.1:9464";
  EXPECT_NE(refusal(config).find("admin address"), std::string::npos);
}

TEST(Configuration, NamesAHalfOfTlsAndAMissingFile) {
  server::ServerConfig config;
  config.tls.certificate = "/nowhere/cert.pem";
  EXPECT_EQ(refusal(config), "TLS must have both a certificate and a key, but it is one of them");
  config.tls.key = "/nowhere/key.pem";
  EXPECT_EQ(refusal(config),
            "TLS certificate /nowhere/cert.pem must be a file that can be read, but it is not "
            "readable");
}

TEST(Configuration, RefusesALimitForEachTokenWithoutTokens) {
  server::ServerConfig config;
  config.limits.max_sessions_per_token = 3;
  EXPECT_NE(refusal(config).find("must come with a token file"), std::string::npos);
  config.limits.max_sessions_per_token = 0;
  config.limits.max_frames_per_second = -1;
  EXPECT_NE(refusal(config).find("frames per second must be at least 0"), std::string::npos);
}

TEST(Configuration, FlagsGoBeforeTheFileAndTheFileBeforeTheEnvironment) {
  const test::SocketAddress place;
  const std::string file = (place.directory() / "server.ini").string();
  std::ofstream(file) << "max-sessions=7\nlinger-ms=1234\nmax-total-bytes=2gb\n";
  setenv("HOLDFAST_CREDITS", "5", 1);
  setenv("HOLDFAST_LINGER_MS", "99", 1);
  server::ServerConfig config;
  CLI::App app;
  server::add_options(app, config);
  std::vector<std::string> reversed{"9", "--max-sessions", file, "--config"};
  app.parse(reversed);
  unsetenv("HOLDFAST_CREDITS");
  unsetenv("HOLDFAST_LINGER_MS");
  EXPECT_EQ(config.limits.max_sessions, 9u);
  EXPECT_EQ(config.limits.linger, 1234ms);
  EXPECT_EQ(config.limits.max_total_bytes, std::size_t{2} << 30);
  EXPECT_EQ(config.limits.credits, 5);
}

TEST(Configuration, RefusesAnUnknownKeyOfTheFile) {
  const test::SocketAddress place;
  const std::string file = (place.directory() / "server.ini").string();
  std::ofstream(file) << "max-session=7\n";
  server::ServerConfig config;
  CLI::App app;
  server::add_options(app, config);
  EXPECT_THROW(app.parse(std::vector<std::string>{file, "--config"}), CLI::ParseError);
}

TEST(Configuration, OfTheDeploymentIsGood) {
  test::ServerProcess check(
      "127.0.0.1:0", {"--check-config", "--config", HOLDFAST_SOURCE "/deploy/holdfast-server.ini"});
  EXPECT_EQ(check.wait(), 0);
}

TEST(Configuration, HasEachKnobInTheManual) {
  std::stringstream manual;
  manual << std::ifstream(HOLDFAST_SOURCE "/docs/server.md").rdbuf();
  server::ServerConfig config;
  CLI::App app;
  server::add_options(app, config);
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (name.find("help") != std::string::npos || name == "--config") continue;
    EXPECT_NE(manual.str().find("| `" + name + "` | `" + option->get_envname() + "` |"),
              std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace holdfast
