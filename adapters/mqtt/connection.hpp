// SPDX-License-Identifier: Apache-2.0
// One attempt to connect, and the connection that may come of it: the only file that knows Paho.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "adapters/mqtt/client.hpp"

namespace kidnapwatch::adapters::mqtt {

/// Called on Paho's threads with Paho's one mutex held: they must wait for nothing.
struct ConnectionEvents {
  /// Exactly once, unless the connection is destroyed before: connected if `error` is empty.
  std::function<void(const std::string& error, bool wrong_protocol)> on_connect_ended;
  std::function<void()> on_lost;
  std::function<void(const Received&)> on_message;
  std::function<void(std::uint64_t ticket)> on_delivered;
  std::function<void(std::uint64_t ticket, const std::string& why)> on_refused;
  std::function<void(const std::string& why)> on_subscription_refused;
};

/// Not thread-safe, and not to be used by its events.
class Connection {
 public:
  enum class Sent : std::uint8_t {
    yes,
    disconnected,  ///< not now: the connection is lost
    unsendable,    ///< never: no topic, or too long
  };

  /// Begins to connect, with MQTT 5 or 4 (which is 3.1.1). `config` outlives the connection.
  Connection(const ClientConfig& config, int protocol, const ConnectionEvents& events);
  /// No event is called from here on.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void subscribe();
  /// Hands the message over; its delivery is told by an event, unless the connection is lost
  /// before.
  Sent publish(std::uint64_t ticket, const std::shared_ptr<const Message>& message);
  /// Says goodbye, waiting no longer than `timeout`.
  void disconnect(std::chrono::milliseconds timeout);

 private:
  struct Paho;
  std::unique_ptr<Paho> paho_;
};

/// `url` as Paho wants it. Throws BadInput naming `broker`.
[[nodiscard]] std::string paho_url(const std::string& url);

}  // namespace kidnapwatch::adapters::mqtt
