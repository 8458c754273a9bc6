// What the transport of frames costs by itself: streams frames of one light through a server of
// this process and prints milliseconds a frame and CPU seconds a gigabyte, filtering excluded as
// far as the server's clock tells it.
//
//   transport_cost [WIDTH HEIGHT FRAMES [unix | tcp]]

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <holdfast/client.h>

#include "server/embedded.h"
#include "server/server.h"
#include "tests/service/test_frames.h"

namespace {

using namespace holdfast;
using Clock = std::chrono::steady_clock;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void measure(const std::string& address, int width, int height, int frames, bool pipelined) {
  const DenoiserConfig config = test::small_config(width, height);
  client::SessionOptions options;
  options.address = address;
  options.width = width;
  options.height = height;
  options.lights = config.lights;
  options.planes = config.planes;
  client::Session session(options);
  std::vector<std::shared_ptr<const Frame>> inputs;
  for (int i = 0; i < frames; ++i)
    inputs.push_back(std::make_shared<const Frame>(test::small_frame(config, i)));
  double core_ms = 0;
  const auto take = [&] {
    auto output = session.receive();
    core_ms += output->timing.core;
    session.recycle(std::move(output->planes));
  };
  constexpr int kWarmUp = 3;
  double cpu = 0;
  Clock::time_point start;
  client::Traffic before;
  for (int i = 0; i < frames; ++i) {
    if (i == kWarmUp) {
      while (session.in_flight() > 0) take();
      cpu = cpu_seconds();
      core_ms = 0;
      start = Clock::now();
      before = session.traffic();
    }
    while (!session.try_submit(inputs[static_cast<std::size_t>(i)])) take();
    if (!pipelined) take();
  }
  session.finish();
  while (auto output = session.receive()) core_ms += output->timing.core;
  const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  const client::Traffic after = session.traffic();
  const double gb =
      1e-9 * static_cast<double>(after.sent - before.sent + after.received - before.received);
  const int n = frames - kWarmUp;
  std::printf("%-10s %6.1f ms a frame, core %6.1f ms, %5.1f MB a frame, %.2f GB/s, %.2f CPU s/GB\n",
              pipelined ? "pipelined" : "lockstep", ms / n, core_ms / n, 1000 * gb / n,
              gb / (ms / 1000), (cpu_seconds() - cpu) / gb);
}

}  // namespace

int main(int argc, char** argv) {
  const int width = argc > 3 ? std::atoi(argv[1]) : 1920;
  const int height = argc > 3 ? std::atoi(argv[2]) : 1080;
  const int frames = argc > 3 ? std::atoi(argv[3]) : 12;
  const bool tcp = argc > 4 && std::strcmp(argv[4], "tcp") == 0;
  server::ServerConfig config;
  config.listen = "127.0.0.1:0";
  config.log_level = "off";
  std::unique_ptr<server::Server> over_tcp;
  std::unique_ptr<server::EmbeddedServer> over_unix;
  if (tcp)
    over_tcp = std::make_unique<server::Server>(config);
  else
    over_unix = std::make_unique<server::EmbeddedServer>();
  const std::string address = tcp ? over_tcp->address() : over_unix->address();
  std::printf("%dx%d over %s\n", width, height, tcp ? "tcp" : "unix socket");
  measure(address, width, height, frames, false);
  measure(address, width, height, frames, true);
}
