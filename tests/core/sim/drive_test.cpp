// SPDX-License-Identifier: Apache-2.0
// A simulated robot drives smoothly, stays free of walls, sees what is there, and feels no
// kidnapping.
#include "core/sim/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::sim {
namespace {

constexpr double kStep = 0.2;  // 5 Hz
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// `a` and `b` mean the same run. NaN never occurs.
bool same(const RecordedScan& a, const RecordedScan& b) {
  return a.true_pose == b.true_pose && a.scan.stamp == b.scan.stamp &&
         a.scan.odometry == b.scan.odometry && a.scan.ranges_m == b.scan.ranges_m;
}

class DriveInAWorld : public ::testing::TestWithParam<World> {
 protected:
  const World& world_ = GetParam();
};

TEST_P(DriveInAWorld, IsTheSameForTheSameSeedAndAnotherForAnother) {
  Drive one(world_, {}, 3, Stamp{});
  Drive again(world_, {}, 3, Stamp{});
  Drive other(world_, {}, 4, Stamp{});
  bool differs = false;
  for (int i = 0; i < 50; ++i) {
    const RecordedScan scan = one.next(kStep);
    EXPECT_TRUE(same(scan, again.next(kStep)));
    differs = differs || !same(scan, other.next(kStep));
  }
  EXPECT_TRUE(differs);
}

TEST_P(DriveInAWorld, MovesSmoothlyAndNeverTouchesAWall) {
  Drive drive(world_, {}, 5, Stamp{});
  Pose before = drive.true_pose();
  double driven_m = 0.0;
  for (int i = 0; i < 5 * 60 * 12; ++i) {  // more than one tour
    drive.next(kStep);
    const Pose now = drive.true_pose();
    const double step_m = distance_m(before, now);
    EXPECT_LE(step_m, 0.22 * kStep + 1e-9);
    EXPECT_LE(std::abs(wrapped(now.theta_rad - before.theta_rad)), 0.8 * kStep + 1e-9);
    ASSERT_GE(clearance_m(world_, {now.x_m, now.y_m}), 0.2) << now.x_m << ", " << now.y_m;
    driven_m += step_m;
    before = now;
  }
  EXPECT_GE(driven_m, 0.7 * 0.22 * 60 * 12);  // and does not dawdle
}

TEST_P(DriveInAWorld, ComesBackToWhereItStarted) {
  Drive drive(world_, {}, 6, Stamp{});
  const Pose start = drive.true_pose();
  double farthest_m = 0.0;
  bool back = false;
  for (int i = 0; i < 5 * 60 * 15 && !back; ++i) {
    drive.next(kStep);
    farthest_m = std::max(farthest_m, distance_m(start, drive.true_pose()));
    back = farthest_m > 4.0 && distance_m(start, drive.true_pose()) < 0.5;
  }
  EXPECT_TRUE(back);
}

TEST_P(DriveInAWorld, GoesOnTouringAfterEveryKidnapping) {
  Drive drive(world_, {}, 7, Stamp{});
  for (const Pose& destination : world_.elsewhere) {
    drive.kidnap(destination);
    EXPECT_EQ(drive.true_pose(), destination);
    for (int i = 0; i < 5 * 60; ++i) {
      drive.next(kStep);
      const Pose now = drive.true_pose();
      ASSERT_GE(clearance_m(world_, {now.x_m, now.y_m}), 0.19) << now.x_m << ", " << now.y_m;
    }
    EXPECT_GE(distance_m(drive.true_pose(), destination), 0.5);
  }
}

TEST_P(DriveInAWorld, IsCarriedFarAway) {
  Drive drive(world_, {}, 8, Stamp{});
  for (int i = 0; i < 10; ++i) {
    const Pose before = drive.true_pose();
    const Pose destination = drive.kidnap_far();
    EXPECT_EQ(drive.true_pose(), destination);
    EXPECT_GE(distance_m(before, destination), 5.0);
    for (int scan = 0; scan < 100; ++scan) drive.next(kStep);
  }
}

TEST_P(DriveInAWorld, DoesNotFeelTheKidnapping) {
  RobotModel exact;
  exact.odometry_noise = 0.0;
  Drive drive(world_, exact, 9, Stamp{});
  const Pose odometry_before = *drive.next(kStep).scan.odometry;
  const Pose destination = drive.kidnap_far();
  const RecordedScan after = drive.next(kStep);
  const Pose felt = inverse(odometry_before) * *after.scan.odometry;
  const Pose moved = inverse(destination) * *after.true_pose;
  EXPECT_LE(distance_m(felt, moved), 1e-9);
  EXPECT_NEAR(felt.theta_rad, moved.theta_rad, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Worlds, DriveInAWorld, ::testing::Values(corridor_world(), room_world()),
                         [](const auto& world) { return world.param.name; });

/// A robot that stands still at (0, 0), facing east, with an exact lidar of four beams.
std::vector<float> ranges_at_origin(const std::vector<Wall>& walls, double noise_sd_m = 0.0) {
  const World world{"walls", walls, {{0, 0}, {1, 0}}, {}};
  RobotModel model;
  model.beams = 4;
  model.speed_mps = 1e-9;
  model.turn_rate_radps = 0.0;
  model.range_noise_sd_m = noise_sd_m;
  Drive drive(world, model, 0, Stamp{});
  drive.kidnap({0, 0, 0});
  return drive.next(kStep).scan.ranges_m;
}

TEST(Drive, MeasuresPlusInfinityWhereNothingIsInReachAndMinusInfinityWhereItIsTooClose) {
  const std::vector<Wall> walls{{{2, -1}, {2, 1}}, {{-1, 3.6}, {1, 3.6}}};
  const auto ranges_m = ranges_at_origin(walls);
  EXPECT_NEAR(ranges_m[0], 2.0F, 1e-6F);
  EXPECT_EQ(ranges_m[1], kInfinity);  // a wall, beyond range_max
  EXPECT_EQ(ranges_m[2], kInfinity);  // no wall

  World narrow{"narrow", {{{-1, 0.1}, {1, 0.1}}}, {{0, 0}, {1, 0}}, {}};
  RobotModel model;
  model.beams = 4;
  model.range_noise_sd_m = 0.0;
  Drive drive(narrow, model, 0, Stamp{});
  EXPECT_TRUE(std::ranges::count(drive.next(1e-6).scan.ranges_m, -kInfinity) == 1);
}

TEST(Drive, MeasuresWithTheNoiseItIsGiven) {
  const World world = room_world();
  RobotModel noisy;
  noisy.range_noise_sd_m = 0.05;
  Drive drive(world, noisy, 11, Stamp{});
  const Fan fan(noisy.beams);
  double squares = 0.0;
  double count = 0.0;
  for (int i = 0; i < 50; ++i) {
    const RecordedScan recorded = drive.next(kStep);
    const auto true_m = sweep(world, *recorded.true_pose, fan, noisy.range_max_m);
    for (std::size_t beam = 0; beam < true_m.size(); ++beam) {
      if (!is_valid(recorded.scan.ranges_m[beam], recorded.scan.geometry)) continue;
      if (true_m[beam] > 3.0) continue;  // where noise may push a range out of reach
      squares += std::pow(static_cast<double>(recorded.scan.ranges_m[beam]) - true_m[beam], 2);
      count += 1.0;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.05, 0.002);
}

TEST(Drive, DriftsByItsOdometryNoise) {
  const World world = corridor_world();
  Drive drive(world, {}, 12, Stamp{});
  const Pose start = drive.true_pose();
  Pose odometry;
  for (int i = 0; i < 500; ++i) odometry = *drive.next(kStep).scan.odometry;
  const Pose moved = inverse(start) * drive.true_pose();
  const double drift_m = distance_m(moved, odometry);
  EXPECT_GT(drift_m, 1e-4);
  EXPECT_LT(drift_m, 0.5);
}

TEST(Drive, StampsAdvanceByTheStep) {
  const World world = room_world();
  const Stamp start = stamp_from_ns(1'700'000'000'000'000'000);
  Drive drive(world, {}, 13, start);
  for (int i = 1; i <= 5; ++i) {
    const RecordedScan recorded = drive.next(kStep);
    EXPECT_EQ(recorded.scan.stamp - start, std::chrono::milliseconds(200 * i));
    EXPECT_NO_THROW(check(recorded.scan));
  }
}

TEST(Drive, RefusesADestinationBehindWalls) {
  const World world = room_world();
  Drive drive(world, {}, 14, Stamp{});
  const Pose before = drive.true_pose();
  EXPECT_THROW(drive.kidnap({-5.0, -5.0, 0.0}), BadInput);
  EXPECT_EQ(drive.true_pose(), before);
}

TEST(Drive, StartsWhereItIsToldTo) {
  const World world = turns_world();
  const Point at = world.path.back();
  Drive drive(world, {}, 1, Stamp{}, {at.x_m, at.y_m, 0.3});
  EXPECT_EQ(drive.true_pose(), (Pose{at.x_m, at.y_m, 0.3}));
  for (int i = 0; i < 100; ++i) drive.next(1.0);
  EXPECT_GE(distance_m(drive.true_pose(), {at.x_m, at.y_m, 0.0}), 8.0);  // it is on its tour
  EXPECT_THROW(Drive(world, {}, 1, Stamp{}, {50.0, 50.0, 0.0}), BadInput);
}

}  // namespace
}  // namespace kidnapwatch::core::sim
