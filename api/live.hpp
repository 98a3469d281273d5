// SPDX-License-Identifier: Apache-2.0
// The robots in few words, for all who watch them: made once a second, however many do.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "api/ports.hpp"

namespace kidnapwatch::api {

/// Any thread.
class LiveRobots {
 public:
  /// `now_s`: seconds of a clock that never goes back. The fleet outlives this.
  LiveRobots(const Fleet& fleet, std::function<double()> now_s)
      : fleet_(fleet), now_s_(std::move(now_s)) {}

  /// {"robots":[...]} of those whose words changed since `version`, at first 0, which is brought up
  /// to date; empty if none did.
  [[nodiscard]] std::string since(std::uint64_t& version,
                                  const std::function<bool(const std::string& robot)>& may_see);

  [[nodiscard]] double now_s() const { return now_s_(); }

 private:
  struct Words {
    std::string json;
    std::uint64_t version = 0;
  };

  void refresh();

  const Fleet& fleet_;
  const std::function<double()> now_s_;
  std::mutex mutex_;
  std::map<std::string, Words> robots_;
  std::uint64_t version_ = 0;
  double refreshed_s_ = 0.0;
};

}  // namespace kidnapwatch::api
