// What the live page is made of: figures of sessions, pictures, and the policy that guards it.
#include "server/live_page.h"

#include <zlib.h>

#include <nlohmann/json.hpp>

#include "client/measure/noisy_composite.h"
#include "server/session_watch.h"
#include "tests/service/http_get.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using namespace std::chrono_literals;
using server::FrameSlot;
using server::PreviewBox;
using server::Rgb8;
using server::SessionWatch;

std::uint32_t big_endian(const std::string& text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i)
    value = value << 8 | static_cast<unsigned char>(text.at(i));
  return value;
}

/// Reads what `png` writes, checking every sum on the way.
Rgb8 read_png(const std::string& file) {
  Rgb8 picture;
  EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::string packed;
  for (std::size_t at = 8; at < file.size();) {
    const std::uint32_t size = big_endian(file, at);
    const std::string checked = file.substr(at + 4, size + 4);
    EXPECT_EQ(big_endian(file, at + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                    static_cast<uInt>(checked.size())));
    if (checked.starts_with("IHDR")) {
      picture.width = static_cast<int>(big_endian(checked, 4));
      picture.height = static_cast<int>(big_endian(checked, 8));
      EXPECT_EQ(checked.substr(12), std::string("\x08\x02\0\0\0", 5)) << "8 bits, RGB";
    }
    if (checked.starts_with("IDAT")) packed += checked.substr(4);
    at += 12 + size;
  }
  const auto row = static_cast<std::size_t>(picture.width) * 3;
  std::string raw((row + 1) * static_cast<std::size_t>(picture.height), '\0');
  uLongf size = static_cast<uLongf>(raw.size());
  EXPECT_EQ(
      uncompress(reinterpret_cast<Bytef*>(raw.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size())),
      Z_OK);
  EXPECT_EQ(size, raw.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    EXPECT_EQ(raw[y * (row + 1)], 0) << "no filter";
    picture.values.insert(picture.values.end(), raw.begin() + static_cast<long>(y * (row + 1) + 1),
                          raw.begin() + static_cast<long>((y + 1) * (row + 1)));
  }
  return picture;
}

TEST(Png, HoldsThePictureForManySizes) {
  for (const int width : {1, 2, 17, 300})
    for (const int height : {1, 5, 64}) {
      Rgb8 picture{width, height, {}};
      for (int i = 0; i < width * height * 3; ++i)
        picture.values.push_back(static_cast<std::uint8_t>(i * 37 + i / 7));
      const Rgb8 read = read_png(server::png(picture));
      EXPECT_EQ(read.width, width);
      EXPECT_EQ(read.height, height);
      EXPECT_EQ(read.values, picture.values);
    }
}

/// What the page shows for a radiance, computed apart.
double shown(double radiance) {
  const double x = radiance / (1 + radiance);
  return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

TEST(Preview, ShowsTheNoisyCompositeAndTheResultSideBySide) {
  for (const int width : {3, 480, 1000}) {
    const DenoiserConfig config = test::small_config(width, 40);
    const Frame frame = test::small_frame(config, 0);
    PlaneSet results;
    Denoiser(config).filter(frame, results);
    const Rgb8 picture = server::preview(frame, results);
    const int step = width > 480 ? 3 : 1;
    ASSERT_EQ(picture.width, 2 * (width / step) + 2);
    ASSERT_EQ(picture.height, 40 / step);
    const Plane noisy = measure::noisy_composite(frame);  // by the definition
    const Plane& clean = results.at({PlaneKind::kComposite, {}});
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < width / step; ++x)
        for (int c = 0; c < 3; ++c) {
          const auto at = [&](int column) {
            return picture.values[static_cast<std::size_t>((y * picture.width + column) * 3 + c)];
          };
          ASSERT_NEAR(at(x), shown(noisy.channel(c).at(x * step, y * step)), 0.51 + 0.01);
          ASSERT_NEAR(at(width / step + 2 + x), shown(clean.channel(c).at(x * step, y * step)),
                      0.51 + 0.01);
        }
  }
}

TEST(PreviewBox, WantsPicturesOnlyWhileSomebodyLooksAndNotTooMany) {
  const PreviewBox::TimePoint start{};
  PreviewBox box;
  EXPECT_FALSE(box.wanted(start));
  EXPECT_TRUE(box.look(start).values.empty());
  EXPECT_TRUE(box.wanted(start));
  box.put({1, 1, {1, 2, 3}}, start);
  EXPECT_FALSE(box.wanted(start + 100ms)) << "the last one is new";
  EXPECT_TRUE(box.wanted(start + 300ms));
  EXPECT_EQ(box.look(start + 300ms).values.size(), 3u);
  EXPECT_FALSE(box.wanted(start + 6s)) << "nobody has looked since";
}

class Watch : public ::testing::Test {
 protected:
  /// A frame that took `i` ms in the filter and was sent at `i` times 10 ms.
  void pass(int i, bool dropped = false) {
    slot.begun = start + i * 10ms - 9ms;
    slot.ended = slot.begun + 1ms;
    slot.started = slot.ended + 2ms;
    slot.answered = slot.started + 3ms;
    slot.decode = 500us;
    slot.encode = 250us;
    const auto answer = std::make_shared<server::Answer>(std::make_shared<server::PlanePool>(0));
    answer->report.ms = i;
    answer->report.mean_history_frames = i / 2.0;
    answer->report.repaired = {{{PlaneKind::kDepth, {}}, 2}};
    answer->dropped = dropped;
    slot.answer = answer;
    watch.sent(slot, "fast", start + i * 10ms);
  }
  const SessionWatch::TimePoint start{};
  FrameSlot slot;
  SessionWatch watch{7};
};

TEST_F(Watch, TellsPercentilesOfTheLastFramesByStage) {
  for (int i = 1; i <= 1000; ++i) pass(i);
  const SessionWatch::Glance glance = watch.glance(start + 10s);
  // Of the last 240: 761 .. 1000; nearest rank.
  EXPECT_EQ(glance.p50[3], 880);
  EXPECT_EQ(glance.p95[3], 988);
  EXPECT_EQ(glance.p50[0], 1);
  EXPECT_EQ(glance.p50[1], 0.5);
  EXPECT_EQ(glance.p50[2], 2);
  EXPECT_EQ(glance.p50[4], 0.25);
  EXPECT_EQ(glance.p50[5], 3);
  EXPECT_EQ(glance.p50[6], 9);
  EXPECT_EQ(glance.frames, 1000u);
  EXPECT_EQ(glance.repaired, 2000u);
  EXPECT_EQ(glance.history_frames, 500);
  EXPECT_EQ(glance.preset, "fast");
  EXPECT_NEAR(glance.frames_per_second, 100, 1);
}

TEST_F(Watch, ForgetsTheRateWhenFramesStayAway) {
  for (int i = 1; i <= 10; ++i) pass(i);
  EXPECT_GT(watch.glance(start + 1s).frames_per_second, 5);
  EXPECT_EQ(watch.glance(start + 10s).frames_per_second, 0);
}

TEST_F(Watch, CountsWhatWasNotFilteredApart) {
  pass(1);
  pass(2, true);
  slot.repeated = true;
  pass(3);
  slot.repeated = false;
  slot.error.emplace();
  pass(4);
  const SessionWatch::Glance glance = watch.glance(start + 1s);
  EXPECT_EQ(glance.frames, 4u);
  EXPECT_EQ(glance.dropped, 1u);
  EXPECT_EQ(glance.repeated, 1u);
  EXPECT_EQ(glance.errors, 1u);
  EXPECT_EQ(glance.p95[3], 1) << "of the first alone";
}

class LivePage : public ::testing::Test {
 protected:
  void start(bool previews) {
    config.admin = "127.0.0.1:0";
    config.admin_previews = previews;
    server = std::make_unique<server::Server>(config);
    client = std::make_unique<test::RawClient>(server->address());
    ASSERT_TRUE(client->create(frames).ok());
    stream = std::make_unique<test::RawStream>(*client);
    stream->attach();
  }
  void pass(int index) {
    stream->write(test::small_frame(frames, index), frames);
    EXPECT_FALSE(stream->read_result().has_error());
  }
  std::string get(const std::string& path) {
    return test::http(server->admin_address(), "GET " + path);
  }
  static std::string body(const std::string& answer) {
    return answer.substr(answer.find("\r\n\r\n") + 4);
  }
  server::ServerConfig config = test::server_config(1);
  const DenoiserConfig frames = test::small_config();
  std::unique_ptr<server::Server> server;
  std::unique_ptr<test::RawClient> client;
  std::unique_ptr<test::RawStream> stream;
};

TEST_F(LivePage, ShowsEachSessionByAnOrdinalAndNoSecret) {
  start(false);
  for (int i = 0; i < 3; ++i) pass(i);
  // Answers are counted when their last byte is written, which the next one shows.
  stream->write(test::small_frame(frames, 3), frames);
  EXPECT_FALSE(stream->read_result().has_error());
  const std::string text = body(get("/sessions.json"));
  const auto json = nlohmann::json::parse(text);
  ASSERT_EQ(json["sessions"].size(), 1u) << text;
  const auto& session = json["sessions"][0];
  EXPECT_EQ(session["session"], 1);
  EXPECT_EQ(session["width"], 37);
  EXPECT_EQ(session["height"], 21);
  EXPECT_EQ(session["recipe"], "reliable");
  EXPECT_EQ(session["preset"], "balanced");
  EXPECT_EQ(session["streaming"], true);
  EXPECT_GE(session["frames"], 3);
  EXPECT_GT(session["history_frames"], 1.0);
  EXPECT_GT(session["memory_bytes"], 37 * 21 * 36);
  for (const char* stage : {"receive", "decode", "filter", "encode", "send", "total"})
    EXPECT_GT(session["ms"][stage]["p95"], 0.0) << stage;
  EXPECT_LE(session["ms"]["filter"]["p50"], session["ms"]["total"]["p50"]);
  EXPECT_EQ(text.find(client->session.session_id()), std::string::npos);
  EXPECT_EQ(text.find(client->session.token()), std::string::npos);
  EXPECT_EQ(json["previews"], false);
  EXPECT_EQ(get("/preview/1.png").find("HTTP/1.1 404"), 0u) << "not unless enabled";
}

TEST_F(LivePage, AllowsItsOwnScriptAlone) {
  start(false);
  const std::string first = get("/"), second = get("/");
  ASSERT_EQ(first.find("HTTP/1.1 200"), 0u);
  const std::string key = "script-src 'nonce-";
  const std::string nonce = first.substr(first.find(key) + key.size(), 32);
  EXPECT_NE(first.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(first.find("<script nonce=\"" + nonce + "\">"), std::string::npos);
  EXPECT_EQ(second.find(nonce), std::string::npos) << "each answer has its own";
  EXPECT_EQ(first.find("http://"), std::string::npos) << "nothing from elsewhere";
  EXPECT_EQ(first.find("https://"), std::string::npos);
}

TEST_F(LivePage, IsNotReadByAPageWhoseNameWasMadeToLeadHere) {
  start(true);
  const auto status = [&](const char* path, const char* host) {
    return test::http(server->admin_address(), std::string("GET ") + path, host).substr(9, 3);
  };
  for (const char* path : {"/", "/sessions.json", "/preview/1.png"})
    for (const char* host :
         {"hostile.example", "hostile.example:9464", "127.0.0.1.hostile.example"})
      EXPECT_EQ(status(path, host), "403") << path << " by " << host;
  for (const char* host : {"localhost:9464", "127.0.0.1:9464", "127.0.0.1"})
    EXPECT_EQ(status("/sessions.json", host), "200") << host;
  EXPECT_EQ(status("/healthz", "prober.example"), "200") << "it tells nothing of sessions";
}

TEST_F(LivePage, ShowsTheLastFrameWhereThatIsEnabled) {
  start(true);
  EXPECT_EQ(get("/preview/1.png").find("HTTP/1.1 404"), 0u) << "there is none yet";
  pass(0);
  const std::string answer = get("/preview/1.png");
  ASSERT_EQ(answer.find("HTTP/1.1 200"), 0u);
  const Rgb8 picture = read_png(body(answer));
  EXPECT_EQ(picture.width, 2 * 37 + 2);
  EXPECT_EQ(picture.height, 21);
  for (const char* path : {"/preview/2.png", "/preview/0.png", "/preview/-1.png", "/preview/1.pn",
                           "/preview/1x.png", "/preview/../1.png"})
    EXPECT_EQ(get(path).find("HTTP/1.1 404"), 0u) << path;
}

}  // namespace
}  // namespace holdfast
