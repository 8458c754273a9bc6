#pragma once

#include <memory>
#include <string>

#include "client/cli/load_session.h"

namespace holdfast::cli {

/// One client of a load: a session, or with `churn_s` one after the other.
class LoadClient {
 public:
  /// What is referred to outlives the client.
  LoadClient(const LoadOptions& options, const std::string& address, LoadFrames& frames)
      : options_(options), address_(address), frames_(frames) {}

  /// Makes the first session; why it could not be made, and then that is counted. Throws
  /// InputError for a rule that its options break.
  std::string make_session();
  /// False if the first session was refused and no other will be asked for.
  bool takes_part() const { return session_ || options_.churn_s > 0; }
  /// Sends from `start` on until the load is over, and waits for all answers. `part`: 0..1, its
  /// place among those that take part; spreads them over a period, as independent ones are.
  void run(std::chrono::steady_clock::time_point start, double part);
  const LoadResult& result() const { return result_; }

 private:
  const LoadOptions& options_;
  const std::string& address_;
  LoadFrames& frames_;
  std::unique_ptr<LoadSession> session_;
  LoadResult result_;
};

}  // namespace holdfast::cli
