// SPDX-License-Identifier: Apache-2.0
// A world of walls, and what a lidar sees in it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.hpp"

namespace kidnapwatch::core::sim {

struct Point {
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const Point&, const Point&) = default;
};

struct Wall {
  Point from;
  Point to;

  friend bool operator==(const Wall&, const Wall&) = default;
};

struct World {
  std::string name;
  std::vector<Wall> walls;
  std::vector<Point> path;      ///< waypoints of a free closed tour through it, at most 1 m apart
  std::vector<Pose> elsewhere;  ///< free poses far from each other, to be carried to
};

/// Corridors 2 m wide on 24 m x 12 m: two loops with a common side, dead ends, door recesses,
/// pillars.
[[nodiscard]] World corridor_world();
/// A furnished room of 12 m x 8 m.
[[nodiscard]] World room_world();

/// The paper's kind of maps: corridors 2 m wide without a feature, and one pose elsewhere.
/// 24 m x 14 m with turns and dead ends; elsewhere is in a dead end.
[[nodiscard]] World turns_world();
/// A straight corridor of 28 m and one of 8 m that ends in it; elsewhere is at that one's end.
[[nodiscard]] World tee_world();
/// A round corridor of 4 m radius: every place looks like every other. Elsewhere is opposite of the
/// tour's beginning.
[[nodiscard]] World ring_world();

/// A world drawn as a floor plan, a character per cell, north up, origin in the south-west corner:
/// '#' is solid, anything else free; 'a', 'b', ... are corners of the closed tour in this order,
/// '0', '1', ... the poses elsewhere, each turned 36 degrees further than the one before. Rows have
/// equal length; the tour's legs cross no wall.
[[nodiscard]] World world_from_plan(std::string_view name, std::span<const std::string_view> rows,
                                    double cell_m);

/// Metres from `from` along the bearing to the nearest wall; infinity if there is none.
[[nodiscard]] double cast_ray(const World& world, Point from, double bearing_rad);

/// Bearings of `beams` beams spread evenly over one turn, counter-clockwise from 0 (straight
/// ahead).
struct Fan {
  explicit Fan(std::size_t beams);

  double increment_rad;
  std::vector<Point> directions;  ///< unit vectors
};

/// Metres along every beam of `fan` to the nearest wall, for a lidar at `sensor`; infinity where
/// none is nearer than `reach_m`.
[[nodiscard]] std::vector<double> sweep(const World& world, const Pose& sensor, const Fan& fan,
                                        double reach_m);

/// Metres from `at` to the nearest wall; infinity in a world without.
[[nodiscard]] double clearance_m(const World& world, Point at);

}  // namespace kidnapwatch::core::sim
