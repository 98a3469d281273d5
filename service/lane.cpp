// SPDX-License-Identifier: Apache-2.0
// Fair, bounded queues in front of one thread.
#include "service/lane.hpp"

#include <utility>

namespace kidnapwatch::service {
namespace {

constexpr std::chrono::milliseconds kTickEvery{250};

}  // namespace

Lane::Lane(std::size_t queue_per_robot, const adapters::codecs::ScanPayloadConfig& payload)
    : queue_per_robot_(queue_per_robot), bench_(payload), thread_([this] { run(); }) {}

Lane::~Lane() { stop(); }

void Lane::add(std::shared_ptr<Watch> watch) {
  const std::lock_guard lock(mutex_);
  const Watch* key = watch.get();
  inboxes_.emplace(key, Inbox{std::move(watch), {}});
}

void Lane::push(Watch& watch, Message message) {
  bool dropped = false;
  bool counts = false;  // odometry is no scan
  {
    const std::lock_guard lock(mutex_);
    Inbox& inbox = inboxes_.at(&watch);
    dropped = inbox.messages.size() >= queue_per_robot_;
    if (dropped) {
      counts = !inbox.messages.front().is_odometry;
      inbox.messages.pop_front();
    } else {
      ++queued_;
    }
    inbox.messages.push_back(std::move(message));
    if (inbox.messages.size() == 1) {
      ready_.push_back(&inbox);
    }
  }
  filled_.notify_one();
  if (counts) {
    watch.count(core::Outcome::overload);
  }
}

std::size_t Lane::queued() const {
  const std::lock_guard lock(mutex_);
  return queued_;
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
      lock.lock();
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
