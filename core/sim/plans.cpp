// SPDX-License-Identifier: Apache-2.0
// The simulated worlds, drawn as floor plans.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "core/sim/world.hpp"

namespace kidnapwatch::core::sim {
namespace {

constexpr double kCell = 0.5;        // m
constexpr double kLongestLeg = 1.0;  // m between waypoints

constexpr std::array<std::string_view, 26> kCorridor{
    "##################################################",
    "#...........#...............#.......##...........#",
    "#................................................#",
    "#..f..........6......ea.......................b..#",
    "#................................................#",
    "#....###..#####..###....#######....####..####....#",
    "#....###############....#######....####..####....#",
    "#.....##############....#######....##########....#",
    "#.....##############.......####.2..##########...##",
    "##...###############.....4.####....##########....#",
    "#....###############.......##################....#",
    "#...........########....#####################....#",
    "#........0..########....################......3..#",
    "#...........#######.....################.........#",
    "#...........#######.....#####################....#",
    "#....###############....##########....#######....#",
    "#..5.###############.....#########....#######....#",
    "#......#############.....#########.1..#######...##",
    "#......#############....##########....######.....#",
    "#....###############....##########....######.....#",
    "#....#####....######....###..#####....#######....#",
    "#................................................#",
    "#..g.................hd......8................c..#",
    "#........................................7.......#",
    "#...............#..............#..........#......#",
    "##################################################",
};

// clang-format off
constexpr std::array<std::string_view, 18> kRoom{
    "##########################",
    "####..##............######",
    "#.....##........6...######",
    "#.0.........c.......######",
    "#...a...b........d.......#",
    "#.........#####..........#",
    "#.........#####.......1..#",
    "#..n......#####..........#",
    "##.....7.........e..hf...#",
    "##..............i.......##",
    "##..........j...........##",
    "#.....##.#......###.....##",
    "#.....##........#...g....#",
    "#.............4.#......#.#",
    "#...m....l...k..#.5...2..#",
    "#.3......................#",
    "#...........##......##...#",
    "##########################",
};
// clang-format on

// Corridors without features, a cell wide. One with turns and dead ends, and a T.
constexpr std::array<std::string_view, 7> kTurns{
    "############", "#b...a####f#", "#.########.#", "#.####.###.#",
    "#.####0###.#", "#c........e#", "############",
};
constexpr std::array<std::string_view, 7> kTee{
    "################", "#a............b#", "#######.########", "#######.########",
    "#######.########", "#######0########", "################",
};
constexpr double kCorridorWidth = 2.0;  // m
constexpr double kRingRadius = 4.0;     // m, of its middle
constexpr int kRingSides = 72;

class Plan {
 public:
  Plan(std::span<const std::string_view> rows, double cell_m) : rows_(rows), cell_m_(cell_m) {}

  [[nodiscard]] long width() const { return static_cast<long>(rows_.front().size()); }
  [[nodiscard]] long height() const { return static_cast<long>(rows_.size()); }

  /// Column from the west, row from the south; solid beyond the plan.
  [[nodiscard]] char at(long column, long row) const {
    if (column < 0 || row < 0 || column >= width() || row >= height()) return '#';
    return rows_[static_cast<std::size_t>(height() - 1 - row)][static_cast<std::size_t>(column)];
  }
  [[nodiscard]] bool solid(long column, long row) const { return at(column, row) == '#'; }
  [[nodiscard]] Point corner(long column, long row) const {
    return {static_cast<double>(column) * cell_m_, static_cast<double>(row) * cell_m_};
  }
  [[nodiscard]] Point centre(long column, long row) const {
    return {(static_cast<double>(column) + 0.5) * cell_m_,
            (static_cast<double>(row) + 0.5) * cell_m_};
  }

 private:
  std::span<const std::string_view> rows_;
  double cell_m_;
};

/// Calls wall(begin, end) for every longest run of places in [0, length) with the same side free.
/// `side` says 0 where there is no wall, else which side is free.
template <typename Side, typename MakeWall>
void for_each_run(long length, Side side, MakeWall wall) {
  long begin = 0;
  for (long i = 1; i <= length; ++i) {
    if (i < length && side(i) == side(begin)) continue;
    if (side(begin) != 0) wall(begin, i);
    begin = i;
  }
}

/// 0 between two cells of a kind, else which of them is solid.
int step_between(bool a_solid, bool b_solid) {
  return static_cast<int>(a_solid) - static_cast<int>(b_solid);
}

std::vector<Wall> walls(const Plan& plan) {
  std::vector<Wall> found;
  for (long row = 0; row <= plan.height(); ++row) {
    for_each_run(
        plan.width(),
        [&](long i) { return step_between(plan.solid(i, row - 1), plan.solid(i, row)); },
        [&](long begin, long end) {
          found.push_back({plan.corner(begin, row), plan.corner(end, row)});
        });
  }
  for (long column = 0; column <= plan.width(); ++column) {
    for_each_run(
        plan.height(),
        [&](long i) { return step_between(plan.solid(column - 1, i), plan.solid(column, i)); },
        [&](long begin, long end) {
          found.push_back({plan.corner(column, begin), plan.corner(column, end)});
        });
  }
  return found;
}

/// The centres of the cells marked with letters or digits, in their order.
std::map<char, Point> marks(const Plan& plan) {
  std::map<char, Point> found;
  for (long row = 0; row < plan.height(); ++row) {
    for (long column = 0; column < plan.width(); ++column) {
      const char mark = plan.at(column, row);
      if (mark != '#' && mark != '.') found.emplace(mark, plan.centre(column, row));
    }
  }
  return found;
}

/// Appends the waypoints of the leg from `from` (without) to `to` (with).
void add_leg(Point from, Point to, std::vector<Point>& path) {
  const double length_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  const long steps = std::lround(std::ceil(length_m / kLongestLeg));
  for (long i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(steps);
    path.push_back(
        {from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)});
  }
}

}  // namespace

World world_from_plan(std::string_view name, std::span<const std::string_view> rows,
                      double cell_m) {
  assert(!rows.empty() && cell_m > 0.0);
  const Plan plan(rows, cell_m);
  World world{std::string(name), walls(plan), {}, {}};
  std::vector<Point> corners;
  for (const auto& [mark, at] : marks(plan)) {
    if (mark >= 'a' && mark <= 'z') corners.push_back(at);
    if (mark < '0' || mark > '9') continue;
    const double turns = static_cast<double>(mark - '0') / 10.0;
    world.elsewhere.push_back({at.x_m, at.y_m, wrapped(turns * 2.0 * std::numbers::pi)});
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    add_leg(corners[i], corners[(i + 1) % corners.size()], world.path);
  }
  return world;
}

namespace {

/// The plan with a tour along `corners`, marks that may come again, and one place elsewhere, `0`.
World corridors(std::string_view name, std::span<const std::string_view> rows,
                std::string_view corners, double heading_elsewhere_rad) {
  const Plan plan(rows, kCorridorWidth);
  const auto at = marks(plan);
  const Point there = at.at('0');
  World world{std::string(name), walls(plan), {}, {{there.x_m, there.y_m, heading_elsewhere_rad}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    add_leg(at.at(corners[i]), at.at(corners[(i + 1) % corners.size()]), world.path);
  }
  return world;
}

Point on_circle(double radius_m, int side) {
  const double bearing_rad = 2.0 * std::numbers::pi * side / kRingSides;
  return {radius_m * std::cos(bearing_rad), radius_m * std::sin(bearing_rad)};
}

}  // namespace

World turns_world() { return corridors("turns", kTurns, "abcefecb", -0.5 * std::numbers::pi); }

World tee_world() { return corridors("tee", kTee, "ab", 0.5 * std::numbers::pi); }

World ring_world() {
  World world{"ring", {}, {}, {{-kRingRadius, 0.0, -0.5 * std::numbers::pi}}};
  for (int side = 0; side < kRingSides; ++side) {
    for (const double radius_m :
         {kRingRadius - 0.5 * kCorridorWidth, kRingRadius + 0.5 * kCorridorWidth}) {
      world.walls.push_back({on_circle(radius_m, side), on_circle(radius_m, side + 1)});
    }
    world.path.push_back(on_circle(kRingRadius, side + 1));
  }
  return world;
}

World corridor_world() { return world_from_plan("corridor", kCorridor, kCell); }

World room_world() { return world_from_plan("room", kRoom, kCell); }

}  // namespace kidnapwatch::core::sim
