#include "client/cli/load.h"

#include <chrono>
#include <optional>
#include <thread>

#include "client/cli/command.h"
#include "client/cli/embedded_server.h"
#include "client/cli/load_session.h"

namespace holdfast::cli {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void LoadTimes::add(const LoadTimes& other) {
  append(latency, other.latency);
  append(client, other.client);
  append(queue, other.queue);
  append(filter, other.filter);
  append(transport, other.transport);
}

double LoadResult::frames_per_second() const {
  return elapsed_s > 0 ? static_cast<double>(answered) / elapsed_s : 0;
}

void LoadResult::add(const LoadResult& other) {
  submitted += other.submitted;
  answered += other.answered;
  reconnects += other.reconnects;
  elapsed_s = std::max(elapsed_s, other.elapsed_s);
  bytes_in += other.bytes_in;
  bytes_out += other.bytes_out;
  times.add(other.times);
  for (const auto& [kind, count] : other.errors) errors[kind] += count;
}

LoadResult run_load(const LoadOptions& options) {
  std::optional<EmbeddedServer> embedded;
  if (options.server.empty()) embedded.emplace(options.threads);
  LoadFrames frames(options);
  LoadResult result;
  result.options = options;
  result.options.width = frames.config().width;
  result.options.height = frames.config().height;
  const std::string address = embedded ? embedded->address() : options.server;

  std::vector<std::unique_ptr<LoadSession>> sessions;
  for (int i = 0; i < options.sessions; ++i) {
    try {
      sessions.push_back(std::make_unique<LoadSession>(options, address, frames));
    } catch (const client::RefusedError& error) {
      if (sessions.empty()) throw ServerUnreachable(error.what());
      ++result.errors["refused"];
    } catch (const client::ConnectionError& error) {
      if (sessions.empty()) throw ServerUnreachable(error.what());
      ++result.errors["connection"];
    }
  }
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    // Apart within one period, as independent clients are.
    const double part = static_cast<double>(i) / static_cast<double>(sessions.size());
    threads.emplace_back([&, i, part] { sessions[i]->run(start, part); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& session : sessions) result.add(session->result());
  return result;
}

}  // namespace holdfast::cli
