#pragma once

#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <holdfast/client.h>

#include "server/server.h"
#include "tests/service/test_frames.h"

namespace holdfast::test {

/// A silent server on a free port of the loopback address.
inline server::ServerConfig server_config(int threads, int credits = 3) {
  server::ServerConfig config;
  config.listen = "127.0.0.1:0";
  config.threads = threads;
  config.limits.credits = credits;
  config.log_level = "off";
  return config;
}

inline client::SessionOptions session_options(const std::string& address,
                                              const DenoiserConfig& config) {
  client::SessionOptions options;
  options.address = address;
  options.width = config.width;
  options.height = config.height;
  options.lights = config.lights;
  options.planes = config.planes;
  options.recipe = config.recipe;
  options.preset = config.preset;
  options.seed = config.seed;
  return options;
}
inline client::SessionOptions session_options(const server::Server& server,
                                              const DenoiserConfig& config) {
  return session_options(server.address(), config);
}

/// A session on a server that may just have been started.
inline client::Session connected(const client::SessionOptions& options) {
  for (int attempts = 0;; ++attempts) try {
      return client::Session(options);
    } catch (const client::ConnectionError&) {
      if (attempts == 5000) throw;  // under sanitizers a server takes long to start
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

/// The results of the core called directly.
inline std::vector<PlaneSet> direct(const DenoiserConfig& config,
                                    const std::vector<Frame>& frames) {
  Denoiser denoiser(config);
  std::vector<PlaneSet> results(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) denoiser.filter(frames[i], results[i]);
  return results;
}

/// The same through a server, as fast as credits allow.
inline std::vector<PlaneSet> served(const client::SessionOptions& options,
                                    const std::vector<Frame>& frames) {
  client::Session session(options);
  EXPECT_EQ(session.shared_memory(), !options.shared_memory.empty());
  std::thread submitter([&] {
    for (const Frame& frame : frames)  // not owned: the frames outlive the session
      session.submit(std::shared_ptr<const Frame>(std::shared_ptr<void>(), &frame));
    session.finish();
  });
  std::vector<PlaneSet> results;
  while (auto output = session.receive()) {
    EXPECT_FALSE(output->error) << output->error->message;
    results.push_back(std::move(output->planes));
  }
  submitter.join();
  session.close();
  return results;
}
inline std::vector<PlaneSet> served(const server::Server& server, const DenoiserConfig& config,
                                    const std::vector<Frame>& frames,
                                    const std::string& wire = "exact") {
  client::SessionOptions options = session_options(server, config);
  options.wire = wire;
  return served(options, frames);
}

/// Both runs gave the same planes with the same bits.
inline void expect_same(const std::vector<PlaneSet>& a, const std::vector<PlaneSet>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_bits(a[i], b[i])) << "frame " << i;
}

}  // namespace holdfast::test
