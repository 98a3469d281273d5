// SPDX-License-Identifier: Apache-2.0
// One connection to an MQTT broker that looks after itself: it comes, comes back, and never blocks.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "adapters/mqtt/message.hpp"
#include "adapters/mqtt/send_queue.hpp"

namespace kidnapwatch::adapters::mqtt {

class Connection;
struct ConnectionEvents;

/// Where the broker is and how it is spoken to.
struct BrokerConfig {
  std::string url = "mqtt://localhost:1883";  ///< or mqtts://, ws://, wss://
  std::string username;                       ///< empty: none
  std::string password;
  std::string ca_file;    ///< PEM, for mqtts; empty: the system's
  std::string cert_file;  ///< PEM, of this client; empty: none
  std::string key_file;
  std::chrono::seconds keep_alive{10};  ///< a dead peer is noticed within three of these
  std::chrono::seconds connect_timeout{5};
  std::chrono::milliseconds backoff_min{100};
  std::chrono::milliseconds backoff_max{5000};
};

struct Subscription {
  std::string filter;
  int qos = 1;
};

struct ClientConfig {
  BrokerConfig broker;
  std::string id;  ///< unique at the broker; empty: the broker chooses
  std::vector<Subscription> subscriptions;
  std::optional<Message> last_will;  ///< published by the broker if this client vanishes
  SendQueueConfig queue;
};

/// What a client tells. None of these may block or throw.
struct ClientEvents {
  /// On Paho's thread, which all clients of a process share.
  std::function<void(const Received&)> on_message;
  /// After every connect, on the client's thread: the moment to say again what a broker may have
  /// lost.
  std::function<void()> on_connected;
  /// A connection that failed or was lost, a message or subscription that was refused: for the log.
  std::function<void(const std::string& what)> on_trouble;
};

struct ClientStats {
  bool connected = false;
  int protocol = 0;            ///< tried last: 5, or 4 for 3.1.1
  std::uint64_t connects = 0;  ///< connections made so far
  std::uint64_t queued = 0;    ///< waiting to be sent
  std::uint64_t in_flight = 0;
  std::uint64_t delivered = 0;
  std::uint64_t dropped = 0;  ///< lost in our queue
  std::uint64_t refused = 0;  ///< by the broker, or not sendable at all
};

/// Connects in the background, for ever, at first and after every loss, with MQTT 5 or, where the
/// broker refuses that, 3.1.1. Every function may be called from any thread, but those that wait
/// not from one of the events. Several clients in one process share Paho's two threads.
class Client {
 public:
  /// Throws BadInput naming a setting that cannot be used.
  Client(const ClientConfig& config, ClientEvents events);
  /// As stop(0 s).
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Begins to connect and returns at once. Once.
  void start();

  /// Puts the message in line, in constant time. See SendQueue for what becomes of it.
  void publish(Message message) noexcept;

  [[nodiscard]] bool wait_connected(std::chrono::milliseconds timeout);
  /// Until a message can be published without one being dropped: flow control for senders that can
  /// wait. False at the timeout.
  [[nodiscard]] bool wait_for_room(std::chrono::milliseconds timeout);
  /// Until everything published was delivered. False at the timeout.
  [[nodiscard]] bool drain(std::chrono::milliseconds timeout);
  /// Drains if there is a connection, then leaves in order, so that no last will is published.
  void stop(std::chrono::milliseconds timeout);

  [[nodiscard]] bool connected() const noexcept { return connected_; }
  [[nodiscard]] ClientStats stats() const;

 private:
  /// How far an attempt to connect has come.
  enum class Attempt : std::uint8_t { pending, made, failed, wrong_protocol };

  void run();
  [[nodiscard]] bool connect();
  [[nodiscard]] Attempt attempt(int protocol);
  [[nodiscard]] std::uint64_t begin_epoch(int protocol);
  [[nodiscard]] ConnectionEvents connection_events(std::uint64_t epoch);
  [[nodiscard]] Attempt await_attempt();
  void serve();
  void send_waiting(std::unique_lock<std::mutex>& lock);
  void send(const SendQueue::Sending& sending);
  void leave(std::unique_lock<std::mutex>& lock);
  [[nodiscard]] bool stopping() const;
  void pause(std::chrono::milliseconds wait);

  // From here on: on Paho's threads. `epoch` tells a connection from the ones before it.
  void connect_ended(std::uint64_t epoch, const std::string& error, bool wrong_protocol);
  void lost(std::uint64_t epoch);
  void delivered(std::uint64_t ticket);
  void refused(std::uint64_t ticket, const std::string& why);
  void trouble(const std::string& what) const;

  const ClientConfig config_;
  const ClientEvents events_;

  mutable std::mutex mutex_;  // never held while Paho is called, for its callbacks take it
  std::condition_variable changed_;
  SendQueue queue_;
  Attempt attempt_ = Attempt::pending;
  std::uint64_t epoch_ = 0;
  bool lost_ = false;  // the connection of this epoch
  std::string told_;   // why it could not be made: told again only when it changes
  bool stopping_ = false;
  ClientStats stats_;  // the counts that queue_ does not keep
  std::atomic<bool> connected_ = false;

  std::unique_ptr<Connection> connection_;  // used by thread_ only
  std::thread thread_;
};

}  // namespace kidnapwatch::adapters::mqtt
