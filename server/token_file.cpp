#include "server/token_file.h"

#include <fstream>

#include "core/frame/error.h"
#include "server/error.h"
#include "server/random_token.h"

namespace holdfast::server {
namespace {

constexpr std::string_view kBearer = "Bearer ";

}  // namespace

TokenFile::TokenFile(std::string file) : file_(std::move(file)) {
  if (file_.empty()) return;
  read();
  if (tokens_.empty())
    throw InputError("token file " + file_, "must have at least one token", "none");
}

void TokenFile::read() {
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(file_, error);
  if (error || changed == changed_) return;
  std::ifstream stream(file_);
  std::vector<std::string> tokens;
  for (std::string line; std::getline(stream, line);)
    if (!line.empty() && line.front() != '#') tokens.push_back(line);
  if (stream.bad()) return;
  tokens_ = std::move(tokens);
  changed_ = changed;
}

std::string TokenFile::check(std::string_view authorization) {
  if (file_.empty()) return {};
  if (!authorization.starts_with(kBearer))
    throw RefusedError(Refusal::kUnauthenticated, "the server asks for a bearer token");
  authorization.remove_prefix(kBearer.size());
  const std::lock_guard lock(mutex_);
  read();
  bool known = false;
  for (const std::string& token : tokens_) known |= equal_secrets(token, authorization);
  if (!known) throw RefusedError(Refusal::kUnauthenticated, "the bearer token is not known");
  return std::string(authorization);
}

}  // namespace holdfast::server
