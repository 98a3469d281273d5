// SPDX-License-Identifier: Apache-2.0
// How often a robot's scores go to the broker: subscribers want to see them, not to drown in them.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

#include "core/robot.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::service {

/// Any thread.
class ScoreRate {
 public:
  /// So many of each robot in a second; 0: none at all.
  explicit ScoreRate(std::size_t per_s) : per_s_(per_s) {}

  /// Whether a score that came at `arrival` is to be published: when the last one of this robot is
  /// long enough ago (or the clock went back), and always when the state is another one.
  [[nodiscard]] bool allows(const std::string& robot, core::RobotState state, core::Stamp arrival);

 private:
  struct Last {
    core::RobotState state;
    core::Stamp arrival;
  };

  const std::size_t per_s_;
  std::mutex mutex_;
  std::unordered_map<std::string, Last> last_;
};

}  // namespace kidnapwatch::service
