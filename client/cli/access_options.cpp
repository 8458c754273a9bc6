#include "client/cli/access_options.h"

#include <fstream>

#include <CLI/CLI.hpp>

namespace holdfast::cli {
namespace {

std::string token_from(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError("token file " + file, "must be a file that can be read", "not");
  for (std::string line; std::getline(stream, line);) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    if (!line.empty() && line.front() != '#') return line;
  }
  throw InputError("token file " + file, "must hold a token on a line of its own", "without one");
}

}  // namespace

void add_access_options(CLI::App& command, CLI::Option* server, Access& access) {
  CLI::Option* const ca =
      command
          .add_option("--tls-ca", access.tls.ca,
                      "PEM file of the authorities that the server's certificate must come from; "
                      "turns encryption on")
          ->needs(server);
  CLI::Option* const certificate =
      command.add_option("--tls-cert", access.tls.certificate, "PEM file, our own certificate")
          ->needs(ca);
  CLI::Option* const key =
      command.add_option("--tls-key", access.tls.key, "PEM file, its private key")
          ->needs(certificate);
  certificate->needs(key);
  command
      .add_option("--tls-name", access.tls.server_name,
                  "name that the server's certificate must have; default: the host of --server")
      ->needs(ca);
  command
      .add_option("--token-file", access.token_file,
                  "file whose first line is the bearer token with which the server admits us")
      ->needs(server);
  command
      .add_option("--shared-memory", access.shared_memory,
                  "PATH of the server's socket for shared memory, if it runs on this machine")
      ->needs(server);
}

void use_access(const Access& access, client::SessionOptions& session) {
  session.tls = access.tls;
  session.shared_memory = access.shared_memory;
  if (!access.token_file.empty()) session.bearer_token = token_from(access.token_file);
}

}  // namespace holdfast::cli
