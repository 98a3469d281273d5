// SPDX-License-Identifier: Apache-2.0
// Rays, sweeps and clearance among wall segments.
#include "core/sim/world.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace kidnapwatch::core::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Point operator-(Point a, Point b) { return {a.x_m - b.x_m, a.y_m - b.y_m}; }
double cross(Point a, Point b) { return a.x_m * b.y_m - a.y_m * b.x_m; }
double dot(Point a, Point b) { return a.x_m * b.x_m + a.y_m * b.y_m; }

double squared_distance(Point at, const Wall& wall) {
  const Point along = wall.to - wall.from;
  const Point to_at = at - wall.from;
  const double length2 = dot(along, along);
  const double share = length2 > 0.0 ? std::clamp(dot(to_at, along) / length2, 0.0, 1.0) : 0.0;
  const Point rest{to_at.x_m - share * along.x_m, to_at.y_m - share * along.y_m};
  return dot(rest, rest);
}

/// Distance along the unit vector `ray` from `from` to the wall: from + t ray = wall.from + s
/// along.
double hit_m(Point from, Point ray, const Wall& wall) {
  const Point along = wall.to - wall.from;
  const Point to_wall = wall.from - from;
  const double denominator = cross(ray, along);
  if (denominator == 0.0) return kInfinity;  // parallel: a wall seen edge-on has no face
  const double t = cross(to_wall, along) / denominator;
  const double s = cross(to_wall, ray) / denominator;
  return t >= 0.0 && s >= 0.0 && s <= 1.0 ? t : kInfinity;
}

/// The wall in the frame of `sensor`, whose axis points along (c, s).
Wall seen_from(const Pose& sensor, double c, double s, const Wall& wall) {
  const auto moved = [&](Point p) {
    const Point d = p - Point{sensor.x_m, sensor.y_m};
    return Point{c * d.x_m + s * d.y_m, c * d.y_m - s * d.x_m};
  };
  return {moved(wall.from), moved(wall.to)};
}

/// Writes a wall, given in the sensor's frame, into the beams that it covers, where it is the
/// nearest.
void draw(const Wall& wall, const Fan& fan, std::vector<double>& ranges_m) {
  const double area = cross(wall.from, wall.to);
  if (area == 0.0) return;                               // edge-on
  const Point first = area > 0.0 ? wall.from : wall.to;  // counter-clockwise
  const Point last = area > 0.0 ? wall.to : wall.from;
  const double begin_rad = std::atan2(first.y_m, first.x_m);
  const double sweep_rad = std::atan2(std::abs(area), dot(first, last));
  // Two walls that meet both get the beam into their corner, however its bearing rounds.
  constexpr double kSlack = 1e-9;
  const auto begin = static_cast<long>(std::ceil(begin_rad / fan.increment_rad - kSlack));
  const auto end =
      static_cast<long>(std::floor((begin_rad + sweep_rad) / fan.increment_rad + kSlack));
  const auto beams = static_cast<long>(ranges_m.size());
  const Point along = last - first;
  for (long i = begin; i <= end; ++i) {
    const auto beam = static_cast<std::size_t>((i + beams) % beams);  // begin >= -beams / 2 - 1
    const double facing = cross(fan.directions[beam], along);
    if (facing > 0.0) ranges_m[beam] = std::min(ranges_m[beam], std::abs(area) / facing);
  }
}

}  // namespace

double cast_ray(const World& world, Point from, double bearing_rad) {
  const Point ray{std::cos(bearing_rad), std::sin(bearing_rad)};
  double nearest_m = kInfinity;
  for (const Wall& wall : world.walls) nearest_m = std::min(nearest_m, hit_m(from, ray, wall));
  return nearest_m;
}

Fan::Fan(std::size_t beams) : increment_rad(2.0 * std::numbers::pi / static_cast<double>(beams)) {
  assert(beams >= 2);
  for (std::size_t i = 0; i < beams; ++i) {
    const double bearing_rad = static_cast<double>(i) * increment_rad;
    directions.push_back({std::cos(bearing_rad), std::sin(bearing_rad)});
  }
}

std::vector<double> sweep(const World& world, const Pose& sensor, const Fan& fan, double reach_m) {
  std::vector<double> ranges_m(fan.directions.size(), reach_m);
  const double c = std::cos(sensor.theta_rad);
  const double s = std::sin(sensor.theta_rad);
  for (const Wall& wall : world.walls) {
    if (squared_distance({sensor.x_m, sensor.y_m}, wall) >= reach_m * reach_m) continue;
    draw(seen_from(sensor, c, s, wall), fan, ranges_m);
  }
  std::replace(ranges_m.begin(), ranges_m.end(), reach_m, kInfinity);
  return ranges_m;
}

double clearance_m(const World& world, Point at) {
  double nearest2 = kInfinity;
  for (const Wall& wall : world.walls) nearest2 = std::min(nearest2, squared_distance(at, wall));
  return std::sqrt(nearest2);
}

}  // namespace kidnapwatch::core::sim
