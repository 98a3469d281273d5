// SPDX-License-Identifier: Apache-2.0
// What a client has received and suffered, to be awaited.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "adapters/mqtt/client.hpp"

namespace kidnapwatch::adapters::mqtt {

/// Long enough for a busy machine; only failures take this long.
inline constexpr std::chrono::seconds kPatience{30};

struct Letter {
  std::string topic;
  std::string payload;
  std::string content_type;
  bool retained = false;
  std::string response_topic = {};
  std::string correlation = {};

  friend bool operator==(const Letter&, const Letter&) = default;
};

class Inbox {
 public:
  void add(const Received& received) {
    note([&] {
      letters_.push_back({std::string(received.topic), *received.payload,
                          std::string(received.content_type), received.retained,
                          std::string(received.response_topic), std::string(received.correlation)});
    });
  }
  void clear() {
    note([&] { letters_.clear(); });
  }
  void add_trouble(const std::string& what) {
    note([&] { troubles_.push_back(what); });
  }

  /// Whether `condition` of all letters held before patience ran out.
  [[nodiscard]] bool wait(const std::function<bool(const std::vector<Letter>&)>& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return condition(letters_); });
  }
  [[nodiscard]] bool wait_count(std::size_t count) {
    return wait([count](const auto& letters) { return letters.size() >= count; });
  }
  [[nodiscard]] bool wait_payload(const std::string& payload) {
    return wait([&](const auto& letters) {
      return std::ranges::find(letters, payload, &Letter::payload) != letters.end();
    });
  }
  [[nodiscard]] bool wait_trouble(const std::string& part) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] {
      return std::ranges::any_of(troubles_, [&](const std::string& trouble) {
        return trouble.find(part) != std::string::npos;
      });
    });
  }
  [[nodiscard]] std::vector<Letter> letters() {
    const std::lock_guard lock(mutex_);
    return letters_;
  }
  [[nodiscard]] ClientEvents events() {
    return {.on_message = [this](const Received& received) { add(received); },
            .on_connected = {},
            .on_trouble = [this](const std::string& what) { add_trouble(what); }};
  }

 private:
  void note(const std::function<void()>& change) {
    {
      const std::lock_guard lock(mutex_);
      change();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Letter> letters_;
  std::vector<std::string> troubles_;
};

}  // namespace kidnapwatch::adapters::mqtt
