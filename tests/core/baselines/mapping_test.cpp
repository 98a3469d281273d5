// SPDX-License-Identifier: Apache-2.0
// A simulated robot's scans make a map of its world, with true poses and with refined odometry.
#include "core/baselines/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"
#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

std::vector<RecordedScan> tour(const sim::World& world, std::size_t scans, double odometry_noise) {
  sim::RobotModel robot;
  robot.range_max_m = 6.0;
  robot.beams = 180;
  robot.odometry_noise = odometry_noise;
  sim::Drive drive(world, robot, 4, {});
  std::vector<RecordedScan> recorded;
  while (recorded.size() < scans) recorded.push_back(drive.next(0.4));
  return recorded;
}

std::vector<Pose> true_poses(const std::vector<RecordedScan>& scans) {
  std::vector<Pose> poses;
  for (const RecordedScan& recorded : scans) poses.push_back(*recorded.true_pose);
  return poses;
}

/// Poses that begin where the run truly began.
std::vector<Pose> placed(std::vector<Pose> poses, const Pose& start) {
  const Pose T_map_start = start * inverse(poses.front());
  for (Pose& pose : poses) pose = T_map_start * pose;
  return poses;
}

double share_near_walls(const GridMap& map, const sim::World& world, double within_m) {
  int walls = 0;
  int near = 0;
  for (long row = 0; row < map.layout.rows; ++row) {
    for (long column = 0; column < map.layout.columns; ++column) {
      if (map.at(column, row) != Cell::occupied) continue;
      ++walls;
      const sim::Point centre{map.layout.centre_x_m(column), map.layout.centre_y_m(row)};
      near += sim::clearance_m(world, centre) <= within_m ? 1 : 0;
    }
  }
  return static_cast<double>(near) / std::max(1, walls);
}

TEST(MapFrom, FindsTheWallsAndTheSpaceBetweenThem) {
  const sim::World world = sim::room_world();
  const auto scans = tour(world, 250, 0.02);
  const GridMap map = map_from(scans, true_poses(scans));
  EXPECT_GT(share_near_walls(map, world, 0.06), 0.98);
  for (const RecordedScan& recorded : scans) {
    const Pose& at = *recorded.true_pose;
    EXPECT_EQ(map.at(map.layout.column_at(at.x_m), map.layout.row_at(at.y_m)), Cell::free);
  }
  EXPECT_EQ(map.at(0, 0), Cell::unknown);  // a corner of the house that no beam reached
}

TEST(MapFrom, PutsTheLidarWhereItSits) {
  Scan scan{{}, {0.0, 0.5, 0.1, 10.0}, {2.0F}, {}};
  MappingConfig config;
  config.T_base_lidar = {0.0, 0.5, 0.5 * std::numbers::pi};
  const std::vector<RecordedScan> scans{{scan, {}}};
  const GridMap map = map_from(scans, std::vector{Pose{1.0, 1.0, 0.0}}, config);
  EXPECT_EQ(map.at(map.layout.column_at(1.0), map.layout.row_at(3.5)), Cell::occupied);
  EXPECT_EQ(map.at(map.layout.column_at(1.0), map.layout.row_at(2.5)), Cell::free);
  EXPECT_EQ(map.at(map.layout.column_at(1.0), map.layout.row_at(1.0)), Cell::unknown);
}

TEST(MapFrom, ForgetsWhoWalkedAway) {
  Scan wall{{}, {0.0, 0.5, 0.1, 10.0}, {4.0F}, {}};
  Scan person = wall;
  person.ranges_m = {2.0F};
  std::vector<RecordedScan> scans{{person, {}}, {person, {}}};
  scans.resize(12, {wall, {}});
  const GridMap map = map_from(scans, std::vector<Pose>(scans.size()));
  const long row = map.layout.row_at(0.0);
  EXPECT_EQ(map.at(map.layout.column_at(2.0), row), Cell::free);
  EXPECT_EQ(map.at(map.layout.column_at(4.0), row), Cell::occupied);
}

TEST(MapFrom, LearnsNothingFromBeamsThatHitNothing) {
  const float inf = std::numeric_limits<float>::infinity();
  Scan scan{{}, {0.0, 0.5, 0.1, 10.0}, {inf, NAN, 0.0F, 10.0F, 9.0F}, {}};
  MappingConfig config;
  config.reach_m = 5.0;
  const GridMap map = map_from(std::vector<RecordedScan>{{scan, {}}}, std::vector<Pose>(1), config);
  EXPECT_TRUE(std::ranges::all_of(map.cells, [](Cell cell) { return cell == Cell::unknown; }));
}

TEST(MapFrom, RefusesPosesThatSpanTheEarth) {
  Scan scan{{}, {0.0, 0.5, 0.1, 10.0}, {2.0F}, {}};
  const std::vector<RecordedScan> scans{{scan, {}}, {scan, {}}};
  EXPECT_THROW(static_cast<void>(map_from(scans, std::vector<Pose>{{}, {1e7, 1e7, 0.0}})),
               BadInput);
}

double worst_error_m(const std::vector<Pose>& poses, const std::vector<RecordedScan>& scans) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    worst_m = std::max(worst_m, distance_m(poses[i], *scans[i].true_pose));
  }
  return worst_m;
}

TEST(RefinePoses, StraightensBadOdometry) {
  const auto scans = tour(sim::room_world(), 250, 0.3);
  std::vector<Pose> odometry;
  for (const RecordedScan& recorded : scans) odometry.push_back(*recorded.scan.odometry);
  const Pose start = *scans.front().true_pose;
  const double before_m = worst_error_m(placed(odometry, start), scans);
  const double after_m = worst_error_m(placed(refine_poses(scans), start), scans);
  EXPECT_GT(before_m, 1.0);
  EXPECT_LT(after_m, 0.15);
}

TEST(RefinePoses, DrivesByScansAloneWhereThereIsNoOdometry) {
  auto scans = tour(sim::room_world(), 120, 0.0);
  for (RecordedScan& recorded : scans) recorded.scan.odometry.reset();
  const auto poses = placed(refine_poses(scans), *scans.front().true_pose);
  EXPECT_LT(worst_error_m(poses, scans), 0.3);
}

TEST(RefinePoses, KeepsOdometryWhereScansSayNothing) {
  auto scans = tour(sim::room_world(), 20, 0.1);
  for (RecordedScan& recorded : scans) {
    std::ranges::fill(recorded.scan.ranges_m, std::numeric_limits<float>::infinity());
  }
  const auto poses = refine_poses(scans);
  const Pose moved = inverse(*scans.front().scan.odometry) * *scans.back().scan.odometry;
  EXPECT_NEAR(distance_m(poses.back(), moved), 0.0, 1e-9);
}

TEST(RefinePoses, OfNoScansAreNone) { EXPECT_TRUE(refine_poses({}).empty()); }

}  // namespace
}  // namespace kidnapwatch::core::baselines
