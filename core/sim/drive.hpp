// SPDX-License-Identifier: Apache-2.0
// A TurtleBot3-like robot that tours a world, and is kidnapped on request. Deterministic by seed.
#pragma once

#include <cstdint>
#include <random>

#include "core/random.hpp"
#include "core/recording.hpp"
#include "core/sim/world.hpp"

namespace kidnapwatch::core::sim {

/// The robot's lidar and wheels; the defaults are a TurtleBot3 with an LDS-01. The lidar sits at
/// the robot's centre and sweeps counter-clockwise from straight ahead.
struct RobotModel {
  std::size_t beams = 360;
  double range_min_m = 0.12;
  double range_max_m = 3.5;
  double range_noise_sd_m = 0.01;
  double speed_mps = 0.22;
  double turn_rate_radps = 0.8;  ///< at most
  double odometry_noise = 0.02;  ///< sd of the error of a motion, as a share of it
};

class Drive {
 public:
  /// The robot starts at a point of the tour that `seed` chooses, heading along it. `world` has a
  /// tour and outlives the drive.
  Drive(const World& world, const RobotModel& model, std::uint64_t seed, Stamp start);

  /// The robot starts at `begin`, and heads for the waypoint nearest to it that it can drive
  /// straight to. Throws BadInput if there is none.
  Drive(const World& world, const RobotModel& model, std::uint64_t seed, Stamp start,
        const Pose& begin);

  /// Moves on for `step_s` (> 0) and scans at the end of it: the first scan is of start + step_s.
  /// Odometry comes from the wheels alone, starts at 0 and does not notice a kidnapping. A beam
  /// with no wall in reach is +inf, one with a wall nearer than range_min -inf (REP 117).
  RecordedScan next(double step_s);

  /// Puts the robot to `destination`; it drives on along its tour from the waypoint that is the
  /// nearest of those it can drive straight to. Throws BadInput if there is none.
  void kidnap(const Pose& destination);

  /// Puts the robot to the pose of world.elsewhere that is farthest away; says which.
  Pose kidnap_far();

  [[nodiscard]] const Pose& true_pose() const noexcept { return T_map_base_; }

 private:
  void move(double step_s);
  void roll(double step_s);
  [[nodiscard]] Scan scan();
  [[nodiscard]] float measured_m(double true_range_m);

  const World& world_;
  RobotModel model_;
  Fan fan_;
  std::mt19937_64 random_;
  Normal normal_;
  Stamp now_;
  std::size_t waypoint_ = 0;  // the robot is heading for it
  Pose T_map_base_;
  Pose T_odom_base_;
};

}  // namespace kidnapwatch::core::sim
