// SPDX-License-Identifier: Apache-2.0
// Fair, bounded queues in front of one thread.
#include "service/lane.hpp"

#include <algorithm>
#include <utility>

namespace kidnapwatch::service {
namespace {

constexpr std::chrono::milliseconds kTickEvery{250};

}  // namespace

Lane::Lane(const LaneConfig& config)
    : queue_per_robot_(config.queue_per_robot),
      scans_per_s_(static_cast<double>(config.scans_per_s)),
      bench_(config.payload),
      thread_([this] { run(); }) {}

Lane::~Lane() { stop(); }

void Lane::add(std::shared_ptr<Watch> watch) {
  const std::lock_guard lock(mutex_);
  const Watch* key = watch.get();
  inboxes_.emplace(key, Inbox{.watch = std::move(watch),
                              .messages = {},
                              .allowance = scans_per_s_,
                              .allowed = std::chrono::steady_clock::now()});
}

/// A bucket of a second's worth, filled steadily.
bool Lane::is_allowed(Inbox& inbox) const {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> since = now - std::exchange(inbox.allowed, now);
  inbox.allowance = std::min(scans_per_s_, inbox.allowance + since.count() * scans_per_s_);
  if (inbox.allowance < 1.0) {
    return false;
  }
  inbox.allowance -= 1.0;
  return true;
}

bool Lane::put(Inbox& inbox, Message message) {
  bool lost_scan = false;
  if (inbox.messages.size() >= queue_per_robot_) {
    const auto oldest = std::ranges::find_if(
        inbox.messages, [](const Message& queued) { return queued.kind != MessageKind::order; });
    if (oldest == inbox.messages.end()) return message.kind == MessageKind::scan;
    lost_scan = oldest->kind == MessageKind::scan;
    inbox.messages.erase(oldest);
  } else {
    ++queued_;
  }
  inbox.messages.push_back(std::move(message));
  if (inbox.messages.size() == 1) {
    ready_.push_back(&inbox);
  }
  return lost_scan;
}

void Lane::push(Watch& watch, Message message) {
  const bool is_scan = message.kind == MessageKind::scan;
  bool lost_scan = false;
  message.queued = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    Inbox& inbox = inboxes_.at(&watch);
    const bool is_order = message.kind == MessageKind::order;
    lost_scan = is_order || is_allowed(inbox) ? put(inbox, std::move(message)) : is_scan;
  }
  filled_.notify_one();
  if (lost_scan) {
    watch.count(core::Outcome::overload);
  }
}

std::size_t Lane::queued() const {
  const std::lock_guard lock(mutex_);
  return queued_;
}

core::Durations Lane::judging() const {
  const std::lock_guard lock(mutex_);
  return judging_;
}

void Lane::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  filled_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

Message Lane::next(Inbox& inbox) {
  Message message = std::move(inbox.messages.front());
  inbox.messages.pop_front();
  --queued_;
  if (!inbox.messages.empty()) {
    ready_.push_back(&inbox);  // to the end: the others come first
  }
  return message;
}

void Lane::run() {
  auto next_tick = std::chrono::steady_clock::now() + kTickEvery;
  std::unique_lock lock(mutex_);
  while (true) {
    filled_.wait_until(lock, next_tick, [&] { return stopping_ || !ready_.empty(); });
    if (!ready_.empty()) {
      Inbox& inbox = *std::exchange(ready_.front(), nullptr);
      ready_.pop_front();
      const Message message = next(inbox);
      lock.unlock();
      inbox.watch->take(message, bench_);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - message.queued;
      lock.lock();
      if (message.kind == MessageKind::scan) judging_.add(took.count());
    } else if (stopping_) {
      return;
    }
    if (std::chrono::steady_clock::now() >= next_tick) {
      lock.unlock();
      tick_all();
      lock.lock();
      next_tick = std::chrono::steady_clock::now() + kTickEvery;
    }
  }
}

void Lane::tick_all() {
  std::vector<std::shared_ptr<Watch>> watches;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, inbox] : inboxes_) {
      watches.push_back(inbox.watch);
    }
  }
  for (const auto& watch : watches) {
    watch->tick();
  }
}

}  // namespace kidnapwatch::service
