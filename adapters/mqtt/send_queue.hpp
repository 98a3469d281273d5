// SPDX-License-Identifier: Apache-2.0
// What is to be published and what the broker has not confirmed: bounded, and in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "adapters/mqtt/message.hpp"

namespace kidnapwatch::adapters::mqtt {

struct SendQueueConfig {
  std::size_t max_queued = 10'000;  ///< then the oldest is dropped
  std::size_t max_in_flight = 100;  ///< handed to the network and not confirmed
};

/// First in, first out. A message of QoS 1 stays until it is confirmed; one of QoS 0 lives only as
/// long as the connection. Not thread-safe.
class SendQueue {
 public:
  struct Sending {
    std::uint64_t ticket = 0;  ///< names this attempt; ascending, never used again
    std::shared_ptr<const Message> message;
  };

  explicit SendQueue(const SendQueueConfig& config) : config_(config) {}

  void push(std::shared_ptr<const Message> message);

  void connection_made() noexcept { connected_ = true; }
  /// What was in flight has to be sent again, before all else, under new tickets.
  void connection_lost();

  [[nodiscard]] bool can_send() const noexcept;
  /// The next message, now in flight; nothing unless can_send().
  [[nodiscard]] std::optional<Sending> next();
  /// Ends a flight, confirmed or refused for good, and hands its message back; null if that flight
  /// ended before.
  [[nodiscard]] std::shared_ptr<const Message> finish(std::uint64_t ticket);

  [[nodiscard]] std::size_t queued() const noexcept { return waiting_.size(); }
  [[nodiscard]] std::size_t in_flight() const noexcept { return in_flight_.size(); }
  [[nodiscard]] bool full() const noexcept { return queued() >= config_.max_queued; }
  [[nodiscard]] bool empty() const noexcept { return waiting_.empty() && in_flight_.empty(); }
  /// Messages lost so far: the oldest of a full queue, and QoS 0 without a connection.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  SendQueueConfig config_;
  std::deque<std::shared_ptr<const Message>> waiting_;
  std::deque<Sending> in_flight_;  // tickets ascending
  std::uint64_t next_ticket_ = 1;
  std::uint64_t dropped_ = 0;
  bool connected_ = false;
};

}  // namespace kidnapwatch::adapters::mqtt
