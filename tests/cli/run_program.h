#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace holdfast::test {

/// The whole of a text file; empty if there is none.
inline std::string file_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A program under test, with its output in a file. Killed at the end if it still runs.
class Program {
 public:
  Program(const std::vector<std::string>& command, std::filesystem::path output)
      : output_(std::move(output)) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    const int rc = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (rc != 0) throw std::runtime_error("cannot start " + command[0]);
  }
  ~Program() {
    if (pid_ <= 0) return;
    kill(SIGKILL);
    wait();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void kill(int signal) const { ::kill(pid_, signal); }
  /// The exit code; 128 + the signal for a program that a signal ended.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// What it has printed so far.
  std::string text() const { return file_text(output_); }
  /// What it has printed after `key`, up to the next space; empty if it has not.
  std::string printed(const std::string& key) const {
    const std::string all = text();
    const std::size_t at = all.find(key);
    if (at == std::string::npos) return {};
    const std::size_t from = at + key.size();
    return all.substr(from, all.find(' ', from) - from);
  }
  /// Waits until it has printed `part`; false after two minutes: a sanitized server
  /// takes long to start beside others.
  bool wait_for(const std::string& part) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (text().find(part) == std::string::npos) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }

 private:
  std::filesystem::path output_;
  pid_t pid_ = 0;
};

}  // namespace holdfast::test
