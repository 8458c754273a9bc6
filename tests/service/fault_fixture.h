#pragma once

#include <thread>

#include <gtest/gtest.h>
#include <holdfast/client.h>

#include "tests/sanitizers.h"
#include "tests/service/fault_table.h"
#include "tests/service/raw_client.h"
#include "tests/service/served.h"
#include "tests/service/server_process.h"

namespace holdfast::test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using client::Session;
using client::SessionOptions;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A server of its own process at a unix socket, and clients of it.
class Fault : public ::testing::Test {
 protected:
  SessionOptions options() const {
    SessionOptions out = session_options(socket.address(), config);
    out.shared_memory = shared_memory;
    return out;
  }
  /// A session on a server that may just have been started.
  Session connect() const { return connected(options()); }
  void pass(Session& session, int index) const {
    session.submit(small_frame(config, index));
    const auto output = session.receive();
    ASSERT_TRUE(output);
    EXPECT_FALSE(output->error) << output->error->message;
    EXPECT_EQ(output->index, index);
  }

  SocketAddress socket;
  DenoiserConfig config = small_config();
  std::string shared_memory;  ///< path of the server's side socket; empty = none
};

}  // namespace holdfast::test
