#include "client/cli/load.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <thread>

#include "client/cli/command.h"
#include "client/cli/embedded_server.h"
#include "client/cli/load_client.h"

namespace holdfast::cli {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void LoadTimes::add(const LoadTimes& other) {
  append(at_s, other.at_s);
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
  dropped += other.dropped;
  skipped += other.skipped;
  late += other.late;
  clients += other.clients;
  reconnects += other.reconnects;
  sharing += other.sharing;
  elapsed_s = std::max(elapsed_s, other.elapsed_s);
  bytes_in += other.bytes_in;
  bytes_out += other.bytes_out;
  times.add(other.times);
  for (const auto& [kind, count] : other.errors) errors[kind] += count;
}

LoadResult run_load(const LoadOptions& given) {
  LoadOptions options = given;
  // The relay has another address, but the certificate is still that of the server.
  client::TlsFiles& tls = options.access.tls;
  if (!options.link.plain() && !tls.ca.empty() && tls.server_name.empty())
    tls.server_name = options.server.starts_with("unix:")
                          ? "localhost"
                          : options.server.substr(0, options.server.rfind(':'));
  std::optional<EmbeddedServer> embedded;
  if (options.server.empty()) embedded.emplace(options.threads);
  std::string address = embedded ? embedded->address() : options.server;
  std::optional<Relay> relay;
  if (!options.link.plain()) address = relay.emplace(address, options.link).address();

  std::deque<LoadFrames> frames;  // one for each size
  LoadResult result;
  result.options = options;
  for (LoadSize& size : result.options.sizes) {
    frames.emplace_back(options, size);
    size = {frames.back().config().width, frames.back().config().height};
  }
  std::deque<LoadClient> clients;
  for (int i = 0; i < options.sessions; ++i) {
    clients.emplace_back(options, address, frames[static_cast<std::size_t>(i) % frames.size()]);
    const std::string refusal = clients.back().make_session();
    if (!refusal.empty() && clients.size() == 1) throw ServerUnreachable(refusal);
  }
  const auto start = std::chrono::steady_clock::now();
  const auto takes_part = [](const LoadClient& client) { return client.takes_part(); };
  const auto parts = std::count_if(clients.begin(), clients.end(), takes_part);
  std::vector<std::thread> threads;
  for (LoadClient& client : clients) {
    if (!client.takes_part()) continue;
    const double part = static_cast<double>(threads.size()) / static_cast<double>(parts);
    threads.emplace_back([&client, start, part] { client.run(start, part); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const LoadClient& client : clients) result.add(client.result());
  return result;
}

}  // namespace holdfast::cli
