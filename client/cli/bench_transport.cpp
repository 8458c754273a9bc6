#include "client/cli/bench_transport.h"

#include <algorithm>
#include <chrono>
#include <memory>

#include <glm/gtc/matrix_transform.hpp>
#include <holdfast/client.h>

#include "client/cli/percentiles.h"
#include "client/cli/raw_echo.h"
#include "client/cli/relay.h"
#include "client/cli/server_child.h"
#include "proto/shared_memory.h"

namespace holdfast::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// A wall before a camera, with 32 bytes a pixel: depth, normal, light and its visibility, which is
/// noise. The filter sees it once.
std::shared_ptr<const Frame> wall(int width, int height) {
  auto frame = std::make_shared<Frame>();
  frame->camera.view_from_world = glm::dmat4(1.0);
  frame->camera.clip_from_view =
      glm::perspective(0.8, static_cast<double>(width) / height, 0.1, 100.0);
  frame->lights[0] = glm::translate(glm::dmat4(1.0), {0.0, 0.0, 2.0});
  const auto add = [&](PlaneId id, auto value) {
    Plane& plane = frame->planes.add(id, width, height);
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) plane.channel(c).at(x, y) = value(c);
  };
  std::uint32_t state = 1;
  add({PlaneKind::kDepth, {}}, [](int) { return 5.0f; });
  add({PlaneKind::kNormal, {}}, [](int c) { return c == 2 ? 1.0f : 0.0f; });
  add(PlaneId::of_light(PlaneKind::kUnshadowed, 0), [](int) { return 0.5f; });
  add(PlaneId::of_light(PlaneKind::kVisibility, 0), [&](int) {
    state = state * 1664525u + 1013904223u;
    return state >> 31 ? 1.0f : 0.0f;
  });
  return frame;
}

/// A session over one link, which sends one frame again and again.
class RepeatedFrame {
 public:
  RepeatedFrame(const std::string& link, const ServerChild& server, const TransportOptions& options)
      : link_(link),
        server_(server),
        relay_(relay(options)),
        frame_(wall(options.width, options.height)),
        neighbour_(session_options(options)),
        session_(session_options(options)),
        resident_before_(resident_with_scratch()) {
    if (link_ == "shared" && !session_.shared_memory())
      throw std::runtime_error("the session got no shared memory");
    run(1 + kWarmUp);
    const client::Traffic one = session_.traffic();
    up_ = one.sent / (1 + kWarmUp);
    down_ = one.received / (1 + kWarmUp);
  }

  std::size_t up() const { return up_; }
  std::size_t down() const { return down_; }
  int credits() const { return session_.credits(); }
  const std::string& link() const { return link_; }

  TransportCost measure(int frames) {
    const double cpu = own_cpu_seconds() + server_.cpu_seconds();
    const auto start = Clock::now();
    run(frames);
    return {std::chrono::duration<double>(Clock::now() - start).count(),
            own_cpu_seconds() + server_.cpu_seconds() - cpu};
  }
  /// What the server has needed for frames, in frames. Shared memory was there before the first.
  double memory_frames() const {
    const std::size_t shared = session_.shared_memory() ? wire::SharedLayout{}.bytes() : 0;
    return static_cast<double>(server_.peak_bytes() - resident_before_ + shared) /
           static_cast<double>(up_ + down_);
  }

 private:
  static constexpr int kWarmUp = 4;  // repetitions, after the one that is filtered

  std::unique_ptr<Relay> relay(const TransportOptions& options) const {
    if (link_ != "delayed") return nullptr;
    return std::make_unique<Relay>(server_.address(), Link{options.delay_ms, 0});
  }

  client::SessionOptions session_options(const TransportOptions& options) const {
    client::SessionOptions out;
    out.address = relay_ ? relay_->address() : server_.address();
    out.shared_memory = server_.shared_memory();
    out.width = options.width;
    out.height = options.height;
    out.wire = options.wire;
    Light light;
    light.shape = LightShape::kRectangle;
    light.width = 1.5;
    light.height = 0.5;
    out.lights = {light};
    for (const Plane& plane : frame_->planes) out.planes.push_back(plane.id());
    return out;
  }

  /// Bytes of the server once it has filtered a frame of the neighbour: the scratch of the filter
  /// is the server's and no session's, and is to be there before the session's own frames.
  std::size_t resident_with_scratch() {
    neighbour_.submit(frame_);
    if (const auto output = neighbour_.receive(); !output || output->error)
      throw std::runtime_error("the first frame got no answer");
    return server_.resident_bytes();
  }

  void run(int frames) {
    for (int sent = 0, received = 0; received < frames;) {
      if (sent < frames && session_.try_submit(frame_)) {
        ++sent;
        continue;
      }
      client::FrameOutput output = *session_.receive();
      if (output.error) throw std::runtime_error(output.error->message);
      if (output.repeated != (answered_++ > 0))
        throw std::runtime_error("the server did not answer a repeated frame from memory");
      session_.recycle(std::move(output.planes));
      ++received;
    }
  }

  const std::string link_;
  const ServerChild& server_;
  const std::unique_ptr<Relay> relay_;
  const std::shared_ptr<const Frame> frame_;
  client::Session neighbour_, session_;
  const std::size_t resident_before_;
  std::size_t up_ = 0, down_ = 0;
  int answered_ = 0;
};

LinkResult measure_link(RepeatedFrame& session, const TransportOptions& options) {
  const double gb = 1e-9 * static_cast<double>(session.up() + session.down()) * options.frames;
  std::vector<double> raw_rate, rate, ratio, raw_cpu, cpu;
  for (int i = 0; i < options.rounds; ++i) {
    const TransportCost raw =
        raw_echo(session.link() == "tcp" || session.link() == "delayed", session.up(),
                 session.down(), options.frames, session.credits());
    const TransportCost own = session.measure(options.frames);
    raw_rate.push_back(gb / raw.seconds);
    rate.push_back(gb / own.seconds);
    ratio.push_back(raw.seconds / own.seconds);
    raw_cpu.push_back(raw.cpu_seconds / gb);
    cpu.push_back(own.cpu_seconds / gb);
  }
  return {session.link(),  median(raw_rate), median(rate),           median(ratio),
          median(raw_cpu), median(cpu),      session.memory_frames()};
}

}  // namespace

TransportResult run_transport_bench(const TransportOptions& options) {
  // Before gRPC has threads here.
  using enum EmbeddedServer::Link;
  const ServerChild tcp_server(kTcp), unix_server(kUnix), shared_server(kSharedMemory),
      delayed_server(kTcp);
  TransportResult result;
  result.options = options;
  const auto measure = [&](const char* link, const ServerChild& server) {
    RepeatedFrame session(link, server, options);
    result.up_bytes = session.up();
    result.down_bytes = session.down();
    result.links.push_back(measure_link(session, options));
  };
  measure("tcp", tcp_server);
  measure("unix", unix_server);
  measure("shared", shared_server);
  if (options.delay_ms > 0) measure("delayed", delayed_server);
  return result;
}

}  // namespace holdfast::cli
