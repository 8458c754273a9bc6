#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace holdfast::server {

/// The bearer tokens with which clients may make sessions: a file with one a line; empty lines and
/// lines that begin with # are left out. Read again when the file changes, so that a token can be
/// added or taken back without a restart. If the file cannot be read any more, the last tokens
/// stay. Every function may be called from any thread.
class TokenFile {
 public:
  /// An empty name asks for no token. Throws InputError if the file has none.
  explicit TokenFile(std::string file);

  /// `authorization`: the value of that header, empty if there is none. Throws
  /// RefusedError(kUnauthenticated); no message repeats a token. Returns the token; empty if none
  /// is asked for.
  std::string check(std::string_view authorization);

 private:
  void read();

  const std::string file_;
  std::mutex mutex_;
  std::filesystem::file_time_type changed_;
  std::vector<std::string> tokens_;
};

}  // namespace holdfast::server
