// SPDX-License-Identifier: Apache-2.0
// A world of walls, and what a lidar sees in it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/pose.hpp"

namespace kidnapwatch::core::sim {

struct Point {
  double x_m = 0.0;
  double y_m = 0.0;
};

struct Wall {
  Point from;
  Point to;
};

struct World {
  std::string name;
  std::vector<Wall> walls;
  std::vector<Point> path;      ///< waypoints of a free closed tour through it
  std::vector<Pose> elsewhere;  ///< free poses far from each other, to be carried to
};

/// A corridor with turns and dead ends, 2 m wide.
[[nodiscard]] World corridor_world();
/// A furnished room of 12 m x 8 m.
[[nodiscard]] World room_world();

/// Metres from `from` along the bearing to the nearest wall; infinity if there is none.
[[nodiscard]] double cast_ray(const World& world, Point from, double bearing_rad);

/// Metres from `at` to the nearest wall.
[[nodiscard]] double clearance_m(const World& world, Point at);

}  // namespace kidnapwatch::core::sim
