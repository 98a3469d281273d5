// SPDX-License-Identifier: Apache-2.0
// Refused scans and commands in the log, without filling it.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include <spdlog/spdlog.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::service {

/// Logs the 1st, 2nd, 4th, 8th, ... refusal of each robot: a broken robot must not fill the disk.
class RefusalLog {
 public:
  void operator()(const std::string& robot, const core::BadInput& why) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t count = ++counts_[robot];
    if (std::has_single_bit(count)) {
      spdlog::warn("robot {}: refused message {}: {}", robot, count, why.what());
    }
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace kidnapwatch::service
