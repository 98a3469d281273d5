// SPDX-License-Identifier: Apache-2.0
// Composition of poses in the plane.
#include "core/pose.hpp"

#include <cmath>
#include <numbers>

namespace kidnapwatch::core {

double wrapped(double angle_rad) {
  const double turn_rad = 2.0 * std::numbers::pi;
  const double rest_rad = std::remainder(angle_rad, turn_rad);
  return rest_rad <= -std::numbers::pi ? rest_rad + turn_rad : rest_rad;
}

Pose operator*(const Pose& a, const Pose& b) {
  const double c = std::cos(a.theta_rad);
  const double s = std::sin(a.theta_rad);
  return {a.x_m + c * b.x_m - s * b.y_m, a.y_m + s * b.x_m + c * b.y_m,
          wrapped(a.theta_rad + b.theta_rad)};
}

Pose inverse(const Pose& pose) {
  const double c = std::cos(pose.theta_rad);
  const double s = std::sin(pose.theta_rad);
  return {-c * pose.x_m - s * pose.y_m, s * pose.x_m - c * pose.y_m, wrapped(-pose.theta_rad)};
}

double distance_m(const Pose& a, const Pose& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }

}  // namespace kidnapwatch::core
