// SPDX-License-Identifier: Apache-2.0
// Thresholds told, and their median.
#include "service/fleet_threshold.hpp"

#include <algorithm>
#include <vector>

namespace kidnapwatch::service {

void FleetThreshold::tell(const std::string& robot, double own) {
  const std::lock_guard lock(mutex_);
  own_[robot] = own;
  if (own_.size() < kRobotsMin) return;
  std::vector<double> all;
  all.reserve(own_.size());
  for (const auto& [id, threshold] : own_) all.push_back(threshold);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) / 2);  // the lower
  std::ranges::nth_element(all, middle);
  median_.store(*middle, std::memory_order_relaxed);
}

}  // namespace kidnapwatch::service
