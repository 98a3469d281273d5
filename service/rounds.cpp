// SPDX-License-Identifier: Apache-2.0
// Waits, goes a round, waits again.
#include "service/rounds.hpp"

#include <utility>

namespace kidnapwatch::service {

void Rounds::ask() {
  {
    const std::lock_guard lock(mutex_);
    asked_ = true;
  }
  changed_.notify_all();
}

void Rounds::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Rounds::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait_for(lock, every_, [this] { return asked_ || stopping_; });
    if (stopping_) {
      return;
    }
    const bool asked = std::exchange(asked_, false);
    lock.unlock();
    round_(asked);
    lock.lock();
  }
}

}  // namespace kidnapwatch::service
