// SPDX-License-Identifier: Apache-2.0
// A TCP proxy that can be told to misbehave: cut connections, or swallow what passes through.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {

/// Listens on a free port of 127.0.0.1 and passes every connection on to `target_port` there.
class Proxy {
 public:
  explicit Proxy(std::uint16_t target_port);
  ~Proxy();
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;

  /// Ends all connections with a reset, as if both peers had crashed.
  void cut();
  /// From now on nothing passes, while all connections stay open: a pulled cable.
  void swallow(bool on) { swallowing_ = on; }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }

 private:
  struct Pair {
    Socket client;
    Socket target;
  };

  void run();
  void pass_all();
  void accept_one();
  [[nodiscard]] bool pass(const Socket& from, const Socket& to) const;

  std::uint16_t target_port_;
  Socket listener_;
  std::uint16_t port_;
  std::atomic<bool> swallowing_ = false;
  std::atomic<bool> cutting_ = false;
  std::atomic<bool> stopping_ = false;
  std::vector<Pair> pairs_;  // used by thread_ only
  std::thread thread_;
};

}  // namespace kidnapwatch::test
