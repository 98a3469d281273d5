// SPDX-License-Identifier: Apache-2.0
// The service at the broker: scans in by one connection, alerts out by another.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>

#include "adapters/mqtt/client.hpp"
#include "adapters/mqtt/topics.hpp"

namespace kidnapwatch::adapters::mqtt {

struct LinkConfig {
  BrokerConfig broker;
  std::string client_id = "kidnapwatch";  ///< the connections append "-in" and "-out" to it
  TopicsConfig topics;
  SendQueueConfig queue;
  std::string content_type = "application/json";  ///< of all that is published
  std::chrono::seconds alert_expiry{24 * 3600};   ///< at the broker, for robots that are away
  std::string status_schema = {};                 ///< user property of what follows
  // What is retained on service/status:
  std::string online;   ///< while the service is there, until another is given
  std::string stopped;  ///< after it left in order
  std::string offline;  ///< after it vanished: the last will
};

struct LinkEvents {
  /// Whatever came but the service's own messages. On Paho's thread; does not block.
  std::function<void(const Topic&, const Received&)> on_message;
  /// Alerts can go out (again): on a thread of the link.
  std::function<void()> on_connected;
  /// For the log; on any thread.
  std::function<void(const std::string& what)> on_trouble;
};

/// Two connections, because Paho leaves Nagle's algorithm on: behind the acknowledgements of scans
/// an alert of QoS 1 would wait some 40 ms. Both are connected from the start.
class Link {
 public:
  /// Throws BadInput for unusable settings.
  Link(LinkConfig config, LinkEvents events);

  /// Begins to connect and returns at once. No event comes before.
  void start();

  /// `on_delivered` as in Message: the broker has it.
  void publish_alert(std::string_view robot, std::string payload, std::string schema,
                     std::function<void()> on_delivered = {}) noexcept;
  /// Retained: what is told of a robot to those who come later.
  void publish_state(std::string_view robot, std::string payload, std::string schema) noexcept;
  /// Retained on service/status from now on, as long as the service is there.
  void publish_online(std::string payload) noexcept;
  /// The answer to a command to `robot`, with its correlation data. False, and nothing is sent,
  /// where Topics::may_answer says so.
  bool publish_response(std::string_view robot, std::string_view topic, std::string payload,
                        std::string schema, std::string_view correlation) noexcept;
  /// May be lost.
  void publish_score(std::string_view robot, std::string payload, std::string schema) noexcept;

  /// Whether scans can come and alerts can go.
  [[nodiscard]] bool connected() const noexcept { return in_.connected() && out_.connected(); }
  [[nodiscard]] bool wait_connected(std::chrono::milliseconds timeout);
  [[nodiscard]] ClientStats incoming() const { return in_.stats(); }
  [[nodiscard]] ClientStats outgoing() const { return out_.stats(); }

  /// No message comes from here on; alerts can still go.
  void stop_receiving();
  /// As stop_receiving(), sends what waits, at most `timeout` long, says "stopped", and leaves.
  void stop(std::chrono::milliseconds timeout);

 private:
  [[nodiscard]] ClientConfig incoming_config() const;
  [[nodiscard]] ClientConfig outgoing_config() const;
  [[nodiscard]] Message status(const std::string& payload) const;
  [[nodiscard]] std::string online() const;
  void pass_on(const Received& received) const;

  const LinkConfig config_;
  const LinkEvents events_;
  const Topics topics_;
  mutable std::mutex mutex_;  // over online_
  std::string online_;
  Client out_;  // before in_: what comes in may be answered
  Client in_;
};

}  // namespace kidnapwatch::adapters::mqtt
