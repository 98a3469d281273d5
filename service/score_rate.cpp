// SPDX-License-Identifier: Apache-2.0
// The last score of each robot that was published.
#include "service/score_rate.hpp"

#include <chrono>

namespace kidnapwatch::service {

bool ScoreRate::allows(const std::string& robot, core::RobotState state, core::Stamp arrival) {
  if (per_s_ == 0) return false;
  const std::chrono::nanoseconds apart(1'000'000'000 / per_s_);
  const std::lock_guard lock(mutex_);
  const auto [last, is_first] = last_.try_emplace(robot, Last{state, arrival});
  const auto since = arrival - last->second.arrival;
  const bool is_due = since >= apart || since < std::chrono::nanoseconds::zero();
  if (!is_first && !is_due && last->second.state == state) return false;
  last->second = {state, arrival};
  return true;
}

}  // namespace kidnapwatch::service
