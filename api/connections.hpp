// SPDX-License-Identifier: Apache-2.0
// Who is connected: how many may be, and how all of them are told to stop.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <unordered_map>

namespace kidnapwatch::api {

/// What becomes of a new connection.
enum class Place {
  served,
  refused,  ///< told that there are too many
  cut,      ///< not even told
};

/// The connections that there are, each under its own address. Any thread.
class Connections {
 public:
  using Stop = std::function<void()>;

  /// Serves `max_served` at a time, `max_per_peer` of one peer, and refuses so many that it knows
  /// of twice as many, of all and of one peer.
  Connections(std::size_t max_served, std::size_t max_per_peer)
      : max_served_(max_served), max_per_peer_(max_per_peer) {}

  /// `stop` is what close() calls, on its thread, even just after the connection left.
  Place enter(const void* connection, const std::string& peer, Stop stop);

  /// Nothing if it is not in.
  void leave(const void* connection);

  /// Stops all that are in; from now on every new one is cut.
  void close();

  void wait_until_empty(std::chrono::milliseconds at_most);

 private:
  struct Entry {
    Stop stop;
    bool served;
    std::string peer;
  };

  struct Peer {
    std::size_t in = 0;
    std::size_t served = 0;
  };

  const std::size_t max_served_;
  const std::size_t max_per_peer_;
  std::mutex mutex_;
  std::condition_variable left_;
  std::unordered_map<const void*, Entry> in_;
  std::size_t served_ = 0;
  std::unordered_map<std::string, Peer> peers_;  // that are in
  bool closed_ = false;
};

}  // namespace kidnapwatch::api
