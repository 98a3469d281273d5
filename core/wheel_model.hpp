// SPDX-License-Identifier: Apache-2.0
// How a robot's odometry differs from what its lidar moves, learned while it drives.
#pragma once

#include <Eigen/Core>

#include "core/pose.hpp"

namespace kidnapwatch::core {

/// A motion as odometry tells it, and the one before: the speed may have changed in between.
struct Wheels {
  Pose motion;         ///< T_base_before_now
  double scans = 1.0;  ///< that it took: 1, or more if some were missed
  Pose before;         ///< the motion until then
  double before_scans = 1.0;
  bool by_odometry = true;  ///< else guessed
};

/// Predicts the sensor's motion from odometry: wheels of the wrong size (a share of the motion),
/// stamps that differ (a lag in scans times the change of speed), and a sensor that is not in the
/// base's origin (a lever arm). All of it starts at nothing and is learned by recursive least
/// squares with forgetting, from natural pairs alone.
class WheelModel {
 public:
  /// T_before_now of the sensor, as the wheels let expect.
  [[nodiscard]] Pose expected(const Wheels& wheels) const;

  /// Takes what the lidar saw instead: `seen` is T_before_now of a natural pair, well aligned.
  void learn(const Wheels& wheels, const Pose& seen);

  /// As Tail::visit_learned.
  template <typename Self, typename Visit>
  static void visit_learned(Self& self, Visit& visit) {
    for (auto& number : self.turning_.reshaped()) visit(number);
    for (auto& number : self.going_.reshaped()) visit(number);
    for (auto& number : self.turning_H_.reshaped()) visit(number);
    for (auto& number : self.turning_b_.reshaped()) visit(number);
    for (auto& number : self.going_H_.reshaped()) visit(number);
    for (auto& number : self.going_b_.reshaped()) visit(number);
  }

  [[nodiscard]] const Eigen::Vector2d& turning() const { return turning_; }
  [[nodiscard]] const Eigen::Vector4d& going() const { return going_; }

 private:
  Eigen::Vector2d turning_ = Eigen::Vector2d::Zero();  // share of the turn, lag (scans)
  Eigen::Vector4d going_ = Eigen::Vector4d::Zero();  // share of the way, lag (scans), lever (m, m)
  Eigen::Matrix2d turning_H_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d turning_b_ = Eigen::Vector2d::Zero();
  Eigen::Matrix4d going_H_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d going_b_ = Eigen::Vector4d::Zero();
};

}  // namespace kidnapwatch::core
