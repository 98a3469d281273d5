// SPDX-License-Identifier: Apache-2.0
// A thread that watches its share of the robots, one scan of each in turn.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "service/watch.hpp"

namespace kidnapwatch::service {

/// A robot belongs to one lane, so that its watch needs no lock while it computes. Each robot has a
/// queue of its own: when that is full its oldest message is dropped and counted as `overload`, and
/// no robot waits for more than one message of each other.
class Lane {
 public:
  Lane(std::size_t queue_per_robot, const adapters::codecs::ScanPayloadConfig& payload);
  /// Finishes what is queued, then stops.
  ~Lane();
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  /// Any thread; never blocks for longer than a queue operation. Nothing is taken after stop().
  void add(std::shared_ptr<Watch> watch);
  /// `watch` was added to this lane.
  void push(Watch& watch, Message message);
  [[nodiscard]] std::size_t queued() const;

  /// Finishes what is queued; returns when it is done.
  void stop();

 private:
  struct Inbox {
    std::shared_ptr<Watch> watch;
    std::deque<Message> messages;
  };

  void run();
  [[nodiscard]] Message next(Inbox& inbox);
  void tick_all();

  const std::size_t queue_per_robot_;
  Bench bench_;  // used by thread_ only
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::map<const Watch*, Inbox> inboxes_;
  std::deque<Inbox*> ready_;  // each inbox with messages, once
  std::size_t queued_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace kidnapwatch::service
