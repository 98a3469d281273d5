// SPDX-License-Identifier: Apache-2.0
// The median of the robots' own thresholds, below which none of theirs may be.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace kidnapwatch::service {

/// A robot that saw little of the world so far thinks little of what is normal: the fleet knows
/// better. Any thread may call anything.
class FleetThreshold {
 public:
  static constexpr std::size_t kRobotsMin = 5;  ///< fewer have no median worth the name

  /// What `robot` found its own threshold to be; replaces what it told before.
  void tell(const std::string& robot, double own);

  /// The median of what was told last (of two in the middle the lower); 0 with fewer than
  /// kRobotsMin robots. Takes no lock.
  [[nodiscard]] double median() const { return median_.load(std::memory_order_relaxed); }

 private:
  std::mutex mutex_;  // over own_
  std::map<std::string, double> own_;
  std::atomic<double> median_ = 0.0;
};

}  // namespace kidnapwatch::service
