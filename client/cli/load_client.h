#pragma once

#include <memory>
#include <string>

#include "client/cli/load_session.h"

namespace holdfast::cli {

/// One client of a load: a session, or with `churn_s` one after the other.
class LoadClient {
 public:
  /// `part`: 0..1, its place among all clients; spreads them over a period, as independent ones
  /// are. What is referred to outlives the client.
  LoadClient(const LoadOptions& options, const std::string& address, LoadFrames& frames,
             double part)
      : options_(options), address_(address), frames_(frames), part_(part) {}

  /// Makes the first session; why it could not be made, and then that is counted. Throws
  /// InputError for a rule that its options break.
  std::string make_session();
  /// Sends from `start` on until the load is over, and waits for all answers.
  void run(std::chrono::steady_clock::time_point start);
  const LoadResult& result() const { return result_; }

 private:
  const LoadOptions& options_;
  const std::string& address_;
  LoadFrames& frames_;
  const double part_;
  std::unique_ptr<LoadSession> session_;
  LoadResult result_;
};

}  // namespace holdfast::cli
