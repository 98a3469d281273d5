// SPDX-License-Identifier: Apache-2.0
// Where a robot is in the plane, and how poses compose.
#pragma once

namespace kidnapwatch::core {

/// A pose in SE(2): of a frame in its parent, or a motion of a frame in itself.
struct Pose {
  double x_m = 0.0;
  double y_m = 0.0;
  double theta_rad = 0.0;

  friend bool operator==(const Pose&, const Pose&) = default;
};

/// `angle_rad` moved into (-pi, pi].
[[nodiscard]] double wrapped(double angle_rad);

/// a then b: T_a_c = T_a_b * T_b_c. The angle is wrapped.
[[nodiscard]] Pose operator*(const Pose& a, const Pose& b);

/// T_b_a from T_a_b.
[[nodiscard]] Pose inverse(const Pose& pose);

/// Metres between the two origins.
[[nodiscard]] double distance_m(const Pose& a, const Pose& b);

}  // namespace kidnapwatch::core
