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

#include "core/durations.hpp"
#include "service/watch.hpp"

namespace kidnapwatch::service {

struct LaneConfig {
  std::size_t queue_per_robot = 64;
  std::size_t scans_per_s = 500;  ///< messages of one robot, on average over a second
  adapters::codecs::ScanPayloadConfig payload;
};

/// A robot belongs to one lane, so that its watch needs no lock while it computes. Each robot has a
/// queue of its own: when that is full its oldest message is dropped, counted as `overload` if it
/// was a scan, and no robot waits for more than one message of each other. An order stays: somebody
/// waits for it; one too many for a queue full of orders is dropped itself. What a robot sends
/// above scans_per_s is dropped on arrival, and its scans are counted as `overload` too.
class Lane {
 public:
  explicit Lane(const LaneConfig& config);
  /// Finishes what is queued, then stops.
  ~Lane();
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;

  /// Any thread; never blocks for longer than a queue operation. Nothing is taken after stop().
  void add(std::shared_ptr<Watch> watch);
  /// `watch` was added to this lane.
  void push(Watch& watch, Message message);
  [[nodiscard]] std::size_t queued() const;
  /// Of scans, from push() until the watch is done with them.
  [[nodiscard]] core::Durations judging() const;

  /// Finishes what is queued; returns when it is done.
  void stop();

 private:
  struct Inbox {
    std::shared_ptr<Watch> watch;
    std::deque<Message> messages;
    double allowance;  // scans that it may send now
    std::chrono::steady_clock::time_point allowed;
  };

  void run();
  [[nodiscard]] Message next(Inbox& inbox);
  void tick_all();
  [[nodiscard]] bool is_allowed(Inbox& inbox) const;
  /// True: a scan had to go for it.
  [[nodiscard]] bool put(Inbox& inbox, Message message);

  const std::size_t queue_per_robot_;
  const double scans_per_s_;
  Bench bench_;  // used by thread_ only
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::map<const Watch*, Inbox> inboxes_;
  std::deque<Inbox*> ready_;  // each inbox with messages, once
  std::size_t queued_ = 0;
  core::Durations judging_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace kidnapwatch::service
