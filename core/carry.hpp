// SPDX-License-Identifier: Apache-2.0
// A robot that is carried off slowly: every scan fits the one before, but the way adds up.
#pragma once

#include "core/motion_tuning.hpp"
#include "core/pose.hpp"
#include "core/tail.hpp"

namespace kidnapwatch::core {

/// Sums up, as a vector and forgetting, how far the lidar moved that the wheels did not tell.
/// Errors of a natural drive cancel (late odometry, noise), those of a carried robot add up. A
/// CUSUM over how unusual that sum is for this robot decides.
class Carry {
 public:
  /// `slack` is subtracted from the CUSUM per scan, beside what natural pairs add.
  explicit Carry(float slack = MotionTuning{}.carry_slack);

  /// Takes the next pair: both motions are T_before_now of the sensor. `natural`: nothing is wrong
  /// otherwise, so that it may be learned from. Returns the CUSUM: kAlarm is an alarm.
  float observe(const Pose& expected, const Pose& seen, bool natural);

  /// Starts over after an alarm or a jump; what was learned stays.
  void reset();

  /// As Tail::visit_learned.
  template <typename Self, typename Visit>
  static void visit_learned(Self& self, Visit& visit) {
    Tail::visit_learned(self.way_, visit);
    Tail::visit_learned(self.turn_, visit);
    visit(self.mean_);
  }

  [[nodiscard]] float cusum() const { return cusum_; }
  [[nodiscard]] bool alarmed() const { return cusum_ >= kAlarm; }

  static constexpr float kAlarm = 30.0F;

 private:
  float slack_;
  Tail way_;
  Tail turn_;
  Pose drift_;
  double told_ = 0.0;  // leaky sums of how much the wheels and the lidar moved
  double seen_ = 0.0;
  float mean_ = 0.0F;  // of what natural pairs add
  float cusum_ = 0.0F;
};

}  // namespace kidnapwatch::core
