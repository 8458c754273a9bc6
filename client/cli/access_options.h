#pragma once

#include <string>

#include <holdfast/client.h>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace holdfast::cli {

/// What a server may ask of those who connect to it. All are names of files: a secret on a command
/// line could be read by every user of the machine.
struct Access {
  client::TlsFiles tls;       ///< see SessionOptions::tls
  std::string shared_memory;  ///< see SessionOptions::shared_memory
  std::string token_file;  ///< its first line that is neither empty nor a comment (#) is the token
};

/// Adds --tls-ca, --tls-cert, --tls-key, --tls-name, --token-file and --shared-memory, which go
/// with the option `server`.
void add_access_options(CLI::App& command, CLI::Option* server, Access& access);

/// Fills in `tls`, `bearer_token` and `shared_memory`. Throws InputError naming the token file if
/// it cannot be read or holds no token; the other files are read, and checked, by the session.
void use_access(const Access& access, client::SessionOptions& session);

}  // namespace holdfast::cli
