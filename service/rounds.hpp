// SPDX-License-Identifier: Apache-2.0
// What is to be looked after now and then, on a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace kidnapwatch::service {

class Rounds {
 public:
  /// Calls `round` once in `every`, and soon after ask(): then with true. Never two at a time.
  Rounds(std::chrono::milliseconds every, std::function<void(bool asked)> round)
      : every_(every), round_(std::move(round)), thread_([this] { run(); }) {}
  ~Rounds() { stop(); }
  Rounds(const Rounds&) = delete;
  Rounds& operator=(const Rounds&) = delete;

  /// Any thread; does not wait.
  void ask();
  /// No round begins after this, and none is under way. Once.
  void stop();

 private:
  void run();

  const std::chrono::milliseconds every_;
  const std::function<void(bool asked)> round_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool asked_ = false;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kidnapwatch::service
