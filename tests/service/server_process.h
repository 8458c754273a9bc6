#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace holdfast::test {

extern const char* const kServerProgram;  ///< path of holdfast-server

/// What a server of a test finds around it.
struct Surroundings {
  std::string log_level = "off";
  std::string log_file;  ///< takes stderr; empty = that of the test
  std::vector<std::pair<std::string, std::string>> variables;  ///< of the environment
};

/// holdfast-server as a process of its own, which a test may kill.
class ServerProcess {
 public:
  explicit ServerProcess(const std::string& listen, std::vector<std::string> more = {},
                         const Surroundings& around = {}) {
    more.insert(more.begin(),
                {kServerProgram, "--listen", listen, "--log-level", around.log_level});
    std::vector<char*> arguments;
    for (std::string& argument : more) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      for (const auto& [name, value] : around.variables) setenv(name.c_str(), value.c_str(), 1);
      const int log = around.log_file.empty() ? -1 : open(around.log_file.c_str(), O_WRONLY);
      if (log >= 0) dup2(log, STDERR_FILENO);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
  }
  ~ServerProcess() {
    if (pid_ > 0) signal(SIGKILL), wait();
  }
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void signal(int number) const { kill(pid_, number); }
  /// Stops it where it is, until SIGCONT. Without the wait its threads run on for a while: on a
  /// busy machine for so long that they answer what is sent after this.
  void freeze() const {
    signal(SIGSTOP);
    waitpid(pid_, nullptr, WUNTRACED);
  }
  /// Its exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

/// A unix socket address in a directory of its own.
class SocketAddress {
 public:
  SocketAddress() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "holdfast-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~SocketAddress() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string address() const { return "unix:" + (path_ / "socket").string(); }
  const std::filesystem::path& directory() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace holdfast::test
