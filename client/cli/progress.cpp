#include "client/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace holdfast::cli {

Progress::Progress(std::string label, std::int64_t total, bool quiet)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      silent_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()) {}

Progress::~Progress() { finish(); }

void Progress::update(std::int64_t done) {
  done_ = done;
  const auto interval =
      terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
  const auto now = Clock::now();
  if (silent_ || now - printed_ < interval) return;
  printed_ = now;
  print(done, false);
}

void Progress::finish() {
  if (silent_) return;
  print(done_, true);
  silent_ = true;
}

void Progress::print(std::int64_t done, bool last) {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  const double eta = rate > 0 ? static_cast<double>(total_ - done) / rate : 0;
  const int percent = static_cast<int>(100 * done / total_);
  if (terminal_) {
    const int filled = percent * 30 / 100;
    std::fprintf(stderr, "\r%-24s [%.*s%*s] %3d %%  %.1f/s  %s %.0f s   ", label_.c_str(), filled,
                 "##############################", 30 - filled, "", percent, rate,
                 last ? "took" : "ETA", last ? seconds : eta);
    if (last) std::fputc('\n', stderr);
  } else {
    std::fprintf(stderr, "%s: %lld of %lld (%d %%), %.1f/s, %s %.0f s\n", label_.c_str(),
                 static_cast<long long>(done), static_cast<long long>(total_), percent, rate,
                 last ? "took" : "ETA", last ? seconds : eta);
  }
  std::fflush(stderr);
}

}  // namespace holdfast::cli
