// SPDX-License-Identifier: Apache-2.0
// A room with straight walls to drive a test's robot through.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/scan.hpp"
#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {

struct Line {
  double x0, y0, x1, y1;
};
using Walls = std::vector<Line>;

/// A box with its lower left corner in the origin.
inline Walls box(double width_m, double depth_m) {
  return {{0, 0, width_m, 0},
          {width_m, 0, width_m, depth_m},
          {width_m, depth_m, 0, depth_m},
          {0, depth_m, 0, 0}};
}

/// A box of 8 m x 6 m in which nothing is symmetric.
inline Walls furnished_room() {
  Walls walls = box(8.0, 6.0);
  for (const Line& line : Walls{{2, 0, 2, 1.2},
                                {5, 6, 5.5, 4.5},
                                {6.5, 2, 7.2, 2.6},
                                {0, 4, 1, 4},
                                {3, 3.2, 3.4, 3.2},
                                {3.4, 3.2, 3.4, 3.7}})
    walls.push_back(line);
  return walls;
}

inline double range_to(const Walls& walls, double x, double y, double bearing) {
  double nearest = std::numeric_limits<double>::infinity();
  const double c = std::cos(bearing);
  const double s = std::sin(bearing);
  for (const Line& wall : walls) {
    const double wx = wall.x1 - wall.x0;
    const double wy = wall.y1 - wall.y0;
    const double det = wx * s - wy * c;
    if (std::abs(det) < 1e-12) continue;
    const double along = (wx * (wall.y0 - y) - wy * (wall.x0 - x)) / det;
    const double at = (c * (wall.y0 - y) - s * (wall.x0 - x)) / det;
    if (along > 0.0 && at >= 0.0 && at <= 1.0) nearest = std::min(nearest, along);
  }
  return nearest;
}

/// What a lidar of a whole turn, reaching 10 m, sees from `sensor`.
inline Scan seen_from(const Walls& walls, const Pose& sensor, Stamp stamp = at_s(0.0),
                      std::size_t beams = 360, double noise_sd_m = 0.0, unsigned seed = 0) {
  Scan scan = round_room(1.0, stamp, beams);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (std::size_t i = 0; i < beams; ++i) {
    const double bearing = sensor.theta_rad + scan.geometry.angle_min_rad +
                           static_cast<double>(i) * scan.geometry.angle_increment_rad;
    scan.ranges_m[i] = static_cast<float>(range_to(walls, sensor.x_m, sensor.y_m, bearing) +
                                          noise_sd_m * noise(random));
  }
  return scan;
}

}  // namespace kidnapwatch::core
