// SPDX-License-Identifier: Apache-2.0
// A robot on its tour: steering, wheels, lidar, kidnappings.
#include "core/sim/drive.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::sim {
namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
constexpr double kLongestStep = 0.05;  // s of rolling between two looks at the waypoint
constexpr double kArrived = 0.3;       // m from a waypoint: rounds the corners
constexpr double kBody = 0.2;          // m of room the robot needs around its centre
constexpr double kSteering = 2.0;      // turn rate per rad off the bearing, 1/s

Pose pose_towards(Point at, Point goal) {
  return {at.x_m, at.y_m, std::atan2(goal.y_m - at.y_m, goal.x_m - at.x_m)};
}

double distance_m(const Pose& pose, Point to) {
  return std::hypot(to.x_m - pose.x_m, to.y_m - pose.y_m);
}

/// Whether the robot fits through everywhere on the straight way.
bool can_drive(const World& world, const Pose& from, Point to) {
  const long steps = std::lround(std::ceil(distance_m(from, to) / (0.5 * kBody))) + 1;
  for (long i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(steps);
    const Point at{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)};
    if (clearance_m(world, at) < kBody) return false;
  }
  return true;
}

std::optional<std::size_t> nearest_waypoint(const World& world, const Pose& from) {
  std::optional<std::size_t> nearest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < world.path.size(); ++i) {
    const double away_m = distance_m(from, world.path[i]);
    if (away_m >= nearest_m || !can_drive(world, from, world.path[i])) continue;
    nearest = i;
    nearest_m = away_m;
  }
  return nearest;
}

}  // namespace

Drive::Drive(const World& world, const RobotModel& model, std::uint64_t seed, Stamp start)
    : world_(world), model_(model), fan_(model.beams), random_(seed), now_(start) {
  assert(world.path.size() >= 2);
  const std::size_t begin = random_() % world.path.size();
  waypoint_ = (begin + 1) % world.path.size();
  const Point from = world.path[begin];
  const Point to = world.path[waypoint_];
  const double share = uniform(random_);
  T_map_base_ = pose_towards(
      {from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)}, to);
}

Drive::Drive(const World& world, const RobotModel& model, std::uint64_t seed, Stamp start,
             const Pose& begin)
    : world_(world), model_(model), fan_(model.beams), random_(seed), now_(start) {
  kidnap(begin);
}

RecordedScan Drive::next(double step_s) {
  assert(step_s > 0.0);
  now_ = later_by_s(now_, step_s);
  move(step_s);
  return {scan(), T_map_base_};
}

void Drive::move(double step_s) {
  const Pose before = T_map_base_;
  const long rolls = std::lround(std::ceil(step_s / kLongestStep));
  for (long i = 0; i < rolls; ++i) roll(step_s / static_cast<double>(rolls));
  // The wheels' error grows with the motion of a step, the same way for its whole length.
  const Pose moved = inverse(before) * T_map_base_;
  const double stretch = 1.0 + model_.odometry_noise * normal_(random_);
  const double twist = 1.0 + model_.odometry_noise * normal_(random_);
  T_odom_base_ =
      T_odom_base_ * Pose{stretch * moved.x_m, stretch * moved.y_m, twist * moved.theta_rad};
}

/// Towards the waypoint: turns no faster than it may, and drives only as far as it faces there.
void Drive::roll(double step_s) {
  if (distance_m(T_map_base_, world_.path[waypoint_]) < kArrived) {
    waypoint_ = (waypoint_ + 1) % world_.path.size();
  }
  const Point goal = world_.path[waypoint_];
  const Pose facing = pose_towards({T_map_base_.x_m, T_map_base_.y_m}, goal);
  const double off_rad = wrapped(facing.theta_rad - T_map_base_.theta_rad);
  const double turn_radps =
      std::clamp(kSteering * off_rad, -model_.turn_rate_radps, model_.turn_rate_radps);
  const double facing_share = std::max(0.0, std::cos(off_rad));
  const double forward_m = model_.speed_mps * facing_share * facing_share * step_s;
  T_map_base_ = T_map_base_ * Pose{forward_m, 0.0, turn_radps * step_s};
}

Scan Drive::scan() {
  Scan scan;
  scan.stamp = now_;
  scan.geometry = {0.0, fan_.increment_rad, model_.range_min_m, model_.range_max_m};
  scan.odometry = T_odom_base_;
  scan.ranges_m.reserve(model_.beams);
  for (const double range_m : sweep(world_, T_map_base_, fan_, model_.range_max_m)) {
    scan.ranges_m.push_back(measured_m(range_m));
  }
  return scan;
}

float Drive::measured_m(double true_range_m) {
  if (std::isinf(true_range_m)) return kFloatInfinity;
  const double noisy_m = true_range_m + model_.range_noise_sd_m * normal_(random_);
  if (noisy_m >= model_.range_max_m) return kFloatInfinity;
  if (noisy_m < model_.range_min_m) return -kFloatInfinity;
  return static_cast<float>(noisy_m);
}

void Drive::kidnap(const Pose& destination) {
  const auto waypoint = nearest_waypoint(world_, destination);
  if (!waypoint) throw BadInput("destination", "no straight way from there to the tour");
  T_map_base_ = destination;
  waypoint_ = *waypoint;
}

Pose Drive::kidnap_far() {
  assert(!world_.elsewhere.empty());
  const auto nearer = [this](const Pose& a, const Pose& b) {
    return core::distance_m(T_map_base_, a) < core::distance_m(T_map_base_, b);
  };
  const Pose farthest = *std::max_element(world_.elsewhere.begin(), world_.elsewhere.end(), nearer);
  kidnap(farthest);
  return farthest;
}

}  // namespace kidnapwatch::core::sim
