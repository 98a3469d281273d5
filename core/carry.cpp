// SPDX-License-Identifier: Apache-2.0
// CUSUM over the leaky sum of what the wheels missed.
#include "core/carry.hpp"

#include <algorithm>
#include <cmath>

namespace kidnapwatch::core {
namespace {

constexpr double kKeep = 0.9;          // of the sum per scan: a memory of some 10 scans
constexpr double kOwnMotionMax = 0.5;  // share of a carried robot's motion that its wheels tell
constexpr double kMissedMax = 0.3;     // per scan, metres and radians: jumps are not carries
constexpr float kWayFloor_m = 0.05F;   // sums below this are nothing
constexpr float kTurnFloor_rad = 0.03F;
constexpr float kScaleMin = 0.2F;  // least mean excess of a logarithm
constexpr float kStepMax = 6.0F;
constexpr float kMeanRate = 0.01F;
constexpr float kWarmup_pairs = 60.0F;

float unusual(const Tail& tail, float value) {
  const float q90 = tail.quantile(0.9F);
  const Tail::Excess excess = tail.excess(q90);
  const float mean = excess.count > 0.0F ? excess.sum / excess.count : 0.0F;
  return std::max(0.0F, (value - q90) / std::max(mean, kScaleMin));
}

/// One length for a motion, at a metre of lever.
double amount(const Pose& motion) {
  return std::hypot(motion.x_m, motion.y_m) + std::abs(motion.theta_rad);
}

}  // namespace

Carry::Carry(float slack)
    : slack_(slack), way_(-3.5F, 4.0F, 2000.0F), turn_(-4.0F, 2.0F, 2000.0F) {}

float Carry::observe(const Pose& expected, const Pose& seen, bool natural) {
  const Pose all = inverse(expected) * seen;
  const double share = std::min(
      1.0, kMissedMax / std::max(1e-9, std::hypot(all.x_m, all.y_m) + std::abs(all.theta_rad)));
  const Pose missed{all.x_m * share, all.y_m * share, all.theta_rad * share};
  const Pose turned = inverse({0.0, 0.0, seen.theta_rad}) * Pose{drift_.x_m, drift_.y_m, 0.0};
  drift_ = {kKeep * turned.x_m + missed.x_m, kKeep * turned.y_m + missed.y_m,
            kKeep * drift_.theta_rad + missed.theta_rad};
  const float way = std::log(static_cast<float>(std::hypot(drift_.x_m, drift_.y_m)) + kWayFloor_m);
  const float turn = std::log(static_cast<float>(std::abs(drift_.theta_rad)) + kTurnFloor_rad);
  told_ = kKeep * told_ + amount(expected);
  seen_ = kKeep * seen_ + amount(seen);
  const bool alone = told_ < kOwnMotionMax * seen_;  // wheels that move as well are merely wrong
  const bool warm = way_.count() >= kWarmup_pairs;
  const float step =
      warm && alone ? std::min(unusual(way_, way) + unusual(turn_, turn), kStepMax) : 0.0F;
  cusum_ = std::max(0.0F, cusum_ + step - mean_ - slack_);
  if (natural && cusum_ < 0.5F * kAlarm) {
    way_.learn(way);
    turn_.learn(turn);
    mean_ += kMeanRate * (step - mean_);
  }
  return cusum_;
}

void Carry::reset() {
  cusum_ = 0.0F;
  drift_ = {};
  told_ = seen_ = 0.0;
}

}  // namespace kidnapwatch::core
