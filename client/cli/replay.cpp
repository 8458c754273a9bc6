#include "client/cli/replay.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <holdfast/client.h>
#include <nlohmann/json.hpp>

#include "client/cli/command.h"
#include "client/cli/embedded_server.h"
#include "client/cli/percentiles.h"
#include "client/cli/progress.h"
#include "client/sequence/sequence.h"
#include "core/denoiser/denoiser.h"

namespace holdfast::cli {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::int64_t> chosen_frames(const SequenceReader& sequence,
                                        const ReplayOptions& options) {
  std::vector<std::int64_t> frames = sequence.frame_indices();
  const std::string all = frames.empty() ? "none"
                                         : "in " + std::to_string(frames.front()) + ".." +
                                               std::to_string(frames.back());
  std::erase_if(frames, [&](std::int64_t i) { return i < options.first || i > options.last; });
  if (frames.empty())
    throw InputError("frames to replay from " + sequence.dir().string(),
                     "must be some of the sequence's, which are " + all, "none of them");
  return frames;
}

/// Gradient planes are read and sent only where they can change the results.
bool wants_gradients(const ReplayOptions& options) {
  return recipe_uses(options.recipe, PlaneKind::kGradient);
}

client::SessionOptions session_options(const SequenceReader& sequence, const ReplayOptions& options,
                                       const std::string& address) {
  client::SessionOptions session;
  session.address = address;
  use_access(options.access, session);
  session.width = sequence.header().width;
  session.height = sequence.header().height;
  session.lights = sequence.header().lights;
  session.planes = sequence.planes(wants_gradients(options));
  session.recipe = options.recipe;
  session.preset = options.preset;
  session.indirect_basis = options.indirect_basis;
  session.half_resolution = options.half_resolution;
  session.history = options.history;
  session.wire = options.wire;
  session.budget_ms = options.budget_ms;
  session.reconnect_timeout = std::chrono::milliseconds(options.reconnect_ms);
  session.debug_planes = options.debug;
  for (const std::string& layer : options.layers) {
    const std::optional<PlaneId> id = plane_from_name(layer);
    if (!id)
      throw InputError("layer \"" + layer + "\"",
                       "must be a result plane such as composite or light0.visibility", "unknown");
    session.results.push_back(*id);
  }
  return session;
}

/// One run: keeps the session busy and writes what comes back.
class Replay {
 public:
  Replay(const SequenceReader& sequence, const ReplayOptions& options, const std::string& address)
      : sequence_(sequence),
        options_(options),
        frames_(chosen_frames(sequence, options)),
        session_(session_options(sequence, options, address)),
        progress_("replay " + session_.recipe(), static_cast<std::int64_t>(frames_.size()),
                  options.quiet) {
    std::filesystem::create_directories(options.out);
    if (!options.access.shared_memory.empty() && !session_.shared_memory())
      std::fprintf(stderr, "holdfast: no shared memory at %s; planes go through the stream\n",
                   options.access.shared_memory.c_str());
    result_.recipe = session_.recipe();
    result_.preset = session_.preset();
    result_.width = sequence.header().width;
    result_.height = sequence.header().height;
  }

  ReplayResult run() {
    const Clock::time_point start = Clock::now();
    const bool with_gradients = wants_gradients(options_);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      auto frame = std::make_shared<const Frame>(sequence_.read_frame(frames_[i], with_gradients));
      pace(start, i);
      while (!session_.try_submit(frame)) accept(session_.receive());
      while (accept(session_.try_receive())) {
      }
    }
    result_.with_budget = options_.budget_ms > 0;
    session_.finish();
    while (accept(session_.receive())) {
    }
    const client::Traffic traffic = session_.traffic();
    result_.shared_memory_asked = !options_.access.shared_memory.empty();
    result_.shared_memory = session_.shared_memory();
    result_.bytes_in = traffic.sent;
    result_.bytes_out = traffic.received;
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    result_.preset = std::max_element(result_.presets.begin(), result_.presets.end(), fewer)->first;
    session_.close();
    return result_;
  }

 private:
  void pace(Clock::time_point start, std::size_t frame) const {
    if (options_.fps <= 0) return;
    std::this_thread::sleep_until(
        start + std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(static_cast<double>(frame) / options_.fps)));
  }

  /// Writes an answer; false if there is none.
  bool accept(std::optional<client::FrameOutput> output) {
    if (!output) return false;
    if (output->error && output->error->input) throw *output->error->input;
    if (output->error)
      throw std::runtime_error("frame " + std::to_string(output->index) + ": " +
                               output->error->message);
    write_exr(sequence_file(options_.out, "frame", output->index), output->planes);
    session_.recycle(std::move(output->planes));
    result_.core_ms.push_back(output->timing.core);
    result_.total_ms.push_back(output->timing.total);
    ++result_.presets[output->preset];
    for (const auto& repair : output->repaired) result_.non_finite_in += repair.values;
    result_.non_finite_out += output->non_finite_out;
    progress_.update(++result_.frames);
    return true;
  }

  const SequenceReader& sequence_;
  const ReplayOptions& options_;
  const std::vector<std::int64_t> frames_;
  client::Session session_;
  Progress progress_;
  ReplayResult result_;
};

}  // namespace

ReplayResult replay_sequence(const ReplayOptions& options) {
  const SequenceReader sequence(options.dir);
  std::optional<EmbeddedServer> embedded;
  if (options.server.empty()) embedded.emplace(options.threads);
  try {
    return Replay(sequence, options, embedded ? embedded->address() : options.server).run();
  } catch (const client::ConnectionError& error) {
    throw ServerUnreachable(error.what());
  } catch (const client::RefusedError& error) {
    throw ServerUnreachable(error.what());
  }
}

nlohmann::ordered_json replay_json(const ReplayResult& result) {
  nlohmann::ordered_json json = {
      {"frames", result.frames},
      {"recipe", result.recipe},
      {"preset", result.preset},
      {"width", result.width},
      {"height", result.height},
      {"ms", {{"core", percentiles(result.core_ms)}, {"total", percentiles(result.total_ms)}}},
      {"bytes_in", result.bytes_in},
      {"bytes_out", result.bytes_out},
      {"non_finite_in", result.non_finite_in},
      {"non_finite_out", result.non_finite_out}};
  if (result.with_budget) json["presets"] = result.presets;
  if (result.shared_memory_asked)
    json["shared_memory"] = {{"asked", true}, {"used", result.shared_memory}};
  return json;
}

}  // namespace holdfast::cli
