#include "client/cli/load_client.h"

#include <algorithm>
#include <thread>

namespace holdfast::cli {
namespace {

constexpr std::chrono::milliseconds kPause{100};  // before a client that was refused comes back

}  // namespace

std::string LoadClient::make_session() try {
  session_ = std::make_unique<LoadSession>(options_, address_, frames_);
  return {};
} catch (const client::RefusedError& error) {
  ++result_.errors["refused"];
  return error.what();
} catch (const client::ConnectionError& error) {
  ++result_.errors["connection"];
  return error.what();
}

void LoadClient::run(std::chrono::steady_clock::time_point start, double part) {
  using Seconds = std::chrono::duration<double>;
  const auto since = [&] { return Seconds(std::chrono::steady_clock::now() - start).count(); };
  // The first to leave do so early, so that they do not all leave at once.
  double stay = options_.churn_s * (part > 0 ? part : 1);
  for (double begin = 0; begin < options_.seconds;) {
    if (!session_ && !make_session().empty()) {
      std::this_thread::sleep_for(kPause);
      begin = since();
      continue;
    }
    const double left = options_.seconds - begin;
    const double length = options_.churn_s > 0 ? std::min(stay, left) : left;
    const auto at =
        start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(begin));
    session_->run({start, at, length, part});
    result_.add(session_->result());
    session_.reset();
    begin = std::max(begin + length, since());
    stay = options_.churn_s;
  }
}

}  // namespace holdfast::cli
