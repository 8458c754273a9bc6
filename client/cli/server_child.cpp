#include "client/cli/server_child.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <fstream>
#include <stdexcept>

namespace holdfast::cli {
namespace {

/// The life of the child: tells its address and its socket for shared memory, then waits until
/// `stop` is closed elsewhere.
[[noreturn]] void serve(EmbeddedServer::Link link, int told, int stop) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    const EmbeddedServer server(0, link);
    const std::string text = server.address() + "\n" + server.shared_memory();
    if (write(told, text.data(), text.size()) < 0) _exit(1);
    close(told);
    char ignored = 0;
    while (read(stop, &ignored, 1) > 0) {
    }
  } catch (const std::exception&) {
    _exit(1);
  }
  _exit(0);
}

}  // namespace

ServerChild::ServerChild(EmbeddedServer::Link link) {
  int told[2], stop[2];
  if (pipe(told) != 0 || pipe(stop) != 0) throw std::runtime_error("cannot make a pipe");
  pid_ = fork();
  if (pid_ == 0) {
    close(told[0]);
    close(stop[1]);
    serve(link, told[1], stop[0]);
  }
  close(told[1]);
  close(stop[0]);
  stop_ = stop[1];
  char buffer[256];
  for (ssize_t got = 0; pid_ > 0 && (got = read(told[0], buffer, sizeof buffer)) > 0;)
    address_.append(buffer, static_cast<std::size_t>(got));
  close(told[0]);
  if (const std::size_t end = address_.find('\n'); end != std::string::npos) {
    shared_memory_ = address_.substr(end + 1);
    address_.resize(end);
    return;
  }
  close(stop_);
  if (pid_ > 0) waitpid(pid_, nullptr, 0);
  throw std::runtime_error("the server to be measured did not start");
}

ServerChild::~ServerChild() {
  close(stop_);
  waitpid(pid_, nullptr, 0);
}

double ServerChild::cpu_seconds() const {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the server to be measured is gone");
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::size_t ServerChild::resident_bytes() const { return status_bytes("VmRSS:"); }
std::size_t ServerChild::peak_bytes() const { return status_bytes("VmHWM:"); }

std::size_t ServerChild::status_bytes(const char* key) const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  std::string word;
  std::size_t kib = 0;
  while (status >> word)
    if (word == key && status >> kib) return kib * 1024;
  throw std::runtime_error("the server to be measured is gone");
}

}  // namespace holdfast::cli
