#include "client/cli/load_session.h"

#include <algorithm>
#include <cstring>
#include <thread>

namespace holdfast::cli {
namespace {

double ms_between(std::chrono::steady_clock::time_point a,
                  std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double, std::milli>(b - a).count();
}

client::SessionOptions session_options(const LoadOptions& options, const std::string& address,
                                       const DenoiserConfig& config) {
  client::SessionOptions out;
  out.address = address;
  out.width = config.width;
  out.height = config.height;
  out.lights = config.lights;
  out.planes = config.planes;
  out.recipe = options.recipe;
  out.preset = options.preset;
  use_access(options.access, out);
  out.wire = options.wire;
  out.late_frames = options.latest ? client::LateFrames::kLatest : client::LateFrames::kAll;
  out.frame_deadline_ms = options.deadline_ms;
  if (options.tell_rate) out.frames_per_second = options.fps;
  out.rewarm_frames = 0;  // frames are used again as soon as they are answered
  return out;
}

}  // namespace

LoadFrames::LoadFrames(const LoadOptions& options, const LoadSize& size)
    : source_(options.frames, size.width, size.height), config_(source_.config()) {
  if (recipe_uses(options.recipe, PlaneKind::kGradient)) return;
  std::erase_if(config_.planes, [](PlaneId id) { return id.kind == PlaneKind::kGradient; });
}

Frame LoadFrames::copy(int i) {
  const std::lock_guard lock(mutex_);
  const Frame& from = source_.at(i);
  Frame to;
  to.camera = from.camera;
  to.objects = from.objects;
  to.lights = from.lights;
  for (const PlaneId id : config_.planes) {
    const Plane& plane = from.planes.at(id);
    Plane& copied = to.planes.add(id, plane.width(), plane.height());
    for (int c = 0; c < plane.channels(); ++c)
      for (int y = 0; y < plane.height(); ++y)
        std::memcpy(copied.words(c).row(y), plane.words(c).row(y),
                    static_cast<std::size_t>(plane.width()) * sizeof(std::uint32_t));
  }
  return to;
}

LoadSession::LoadSession(const LoadOptions& options, const std::string& address, LoadFrames& frames)
    : options_(options), session_(session_options(options, address, frames.config())) {
  const auto credits = static_cast<std::size_t>(session_.credits());
  for (std::size_t i = 0; i < credits + 1; ++i)
    ring_.push_back(std::make_shared<Frame>(frames.copy(static_cast<int>(i))));
}

void LoadSession::run(const Span& span) {
  load_start_ = span.load_start;
  std::thread sender([&] { send(span); });
  try {
    while (auto output = session_.receive()) {
      take(*output);
      session_.recycle(std::move(output->planes));
    }
  } catch (const client::ConnectionError&) {
    count_error("connection");
  } catch (const client::RefusedError&) {
    count_error("refused");
  }
  sender.join();
  result_.clients = 1;
  result_.elapsed_s = ms_between(load_start_, Clock::now()) / 1000;
  result_.reconnects = session_.reconnects();
  result_.sharing = session_.shared_memory() ? 1 : 0;
  result_.bytes_in = session_.traffic().sent;
  result_.bytes_out = session_.traffic().received;
}

void LoadSession::send(const Span& span) {
  const auto period = std::chrono::duration<double>(options_.fps > 0 ? 1 / options_.fps : 0);
  const auto at = [&](double periods) {
    return span.start + std::chrono::duration_cast<Clock::duration>(period * periods);
  };
  const Clock::time_point end = span.start + std::chrono::duration_cast<Clock::duration>(
                                                 std::chrono::duration<double>(span.seconds));
  try {
    for (std::int64_t i = 0;; ++i) {
      const Clock::time_point now = Clock::now();
      const Clock::time_point due =
          options_.fps > 0 ? at(static_cast<double>(i) + span.phase) : now;
      if (due >= end) break;
      if (due > now) std::this_thread::sleep_until(due);
      if (overtaken(due, period)) continue;
      const auto sent =
          static_cast<std::size_t>(result_.submitted);  // written by this thread alone
      const std::shared_ptr<Frame>& frame = ring_[sent % ring_.size()];
      frame->index = i;
      // The lock keeps an answer from coming before its client time is known.
      for (;;) {
        {
          const std::lock_guard lock(mutex_);
          if (session_.try_submit(frame)) {
            client_ms_.push_back(options_.fps > 0 ? ms_between(due, Clock::now()) : 0);
            ++result_.submitted;
            break;
          }
        }
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    }
  } catch (const std::exception&) {
    // The session has ended; the receiving side meets the same error and counts it.
  }
  session_.finish();
}

/// True, and counted, if the frame that was due then is left out: the next one is due as well.
bool LoadSession::overtaken(Clock::time_point due, std::chrono::duration<double> period) {
  if (!options_.latest || options_.fps <= 0 || Clock::now() < due + period) return false;
  const std::lock_guard lock(mutex_);
  ++result_.skipped;
  return true;
}

void LoadSession::take(const client::FrameOutput& output) {
  const std::lock_guard lock(mutex_);
  const double client_ms = client_ms_.front();
  client_ms_.pop_front();
  if (output.error) {
    ++result_.errors[output.error->input ? "invalid_frame" : "server_failed"];
    return;
  }
  if (output.deadline_passed) ++result_.late;
  if (output.dropped) {
    ++result_.dropped;
    return;
  }
  const client::FrameTiming& timing = output.timing;
  LoadTimes& times = result_.times;
  ++result_.answered;
  times.at_s.push_back(ms_between(load_start_, Clock::now()) / 1000);
  times.latency.push_back(client_ms + timing.total);
  times.client.push_back(client_ms);
  times.queue.push_back(timing.wait);
  times.filter.push_back(timing.core);
  times.transport.push_back(std::max(0.0, timing.total - timing.wait - timing.core));
}

void LoadSession::count_error(const char* kind) {
  const std::lock_guard lock(mutex_);
  ++result_.errors[kind];
}

}  // namespace holdfast::cli
