// SPDX-License-Identifier: Apache-2.0
// The filter tracks, finds itself, is lost after a kidnapping, and recovers if it may.
#include "core/baselines/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/baselines/particle_scores.hpp"
#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr std::uint64_t kSeed = 11;

const MeasuredMap& room() {
  static const MeasuredMap map(floor_of(sim::room_world()), {});
  return map;
}

/// A robot in the furnished room, and a filter that follows it.
class MclTest : public ::testing::Test {
 protected:
  explicit MclTest(const MclConfig& config = {}) : filter_(room(), config, kSeed) {}

  void start_at_the_truth() {
    see();
    filter_.start_at(*seen_.true_pose);
  }

  /// On by some scans; the last update.
  MclUpdate follow(int scans) {
    MclUpdate update;
    for (int i = 0; i < scans; ++i) {
      const Pose before = *seen_.scan.odometry;
      see();
      update = *filter_.update(seen_.scan, inverse(before) * *seen_.scan.odometry, seen_.true_pose);
    }
    return update;
  }

  void see() { seen_ = drive_.next(0.2); }

  [[nodiscard]] double error_m(const MclUpdate& update) const {
    return distance_m(update.T_map_base, *seen_.true_pose);
  }

  sim::World world_ = sim::room_world();
  sim::Drive drive_{world_, {}, kSeed, {}};
  Mcl filter_;
  RecordedScan seen_;
};

class AugmentedMclTest : public MclTest {
 protected:
  static MclConfig config() {
    MclConfig config;
    config.relocalization = Relocalization::global;
    return config;
  }
  AugmentedMclTest() : MclTest(config()) {}
};

class PerfectMclTest : public MclTest {
 protected:
  static MclConfig config() {
    MclConfig config;
    config.relocalization = Relocalization::perfect;
    return config;
  }
  PerfectMclTest() : MclTest(config()) {}
};

TEST_F(MclTest, TracksFromAKnownStart) {
  start_at_the_truth();
  for (int i = 0; i < 100; ++i) {
    const MclUpdate update = follow(1);
    ASSERT_LT(error_m(update), 0.1);
    ASSERT_NEAR(wrapped(update.T_map_base.theta_rad - seen_.true_pose->theta_rad), 0.0, 0.05);
    ASSERT_GT(update.max_current_weight, 0.8);
    ASSERT_GT(update.share, 0.9);
    ASSERT_EQ(update.random_share, 0.0);
  }
}

TEST_F(MclTest, FindsItselfAnywhereInTheRoom) {
  see();
  for (int trial = 0; trial < 5; ++trial) {
    follow(25);
    filter_.start_anywhere(seen_.scan);
    EXPECT_LT(error_m(follow(25)), 0.1) << trial;
  }
}

TEST_F(MclTest, IsLostAfterAKidnapping) {
  start_at_the_truth();
  const double before = follow(60).max_current_weight;
  drive_.kidnap_far();
  const MclUpdate at = follow(1);
  EXPECT_LT(at.max_current_weight, 0.5 * before);
  EXPECT_GT(error_m(at), 2.0);
  const MclUpdate later = follow(100);
  EXPECT_LT(later.max_current_weight, 0.7 * before);
  EXPECT_GT(error_m(later), 1.0);
}

TEST_F(AugmentedMclTest, FindsItselfAgainAfterAKidnapping) {
  start_at_the_truth();
  EXPECT_LT(follow(60).random_share, 0.02);
  drive_.kidnap_far();
  EXPECT_GT(follow(1).random_share, 0.05);
  const MclUpdate later = follow(100);
  EXPECT_LT(error_m(later), 0.1);
  EXPECT_GT(later.max_current_weight, 0.8);
}

TEST_F(PerfectMclTest, IsPutToTheTruthAfterTheScanThatLostIt) {
  start_at_the_truth();
  EXPECT_FALSE(follow(60).relocalized);
  drive_.kidnap_far();
  const MclUpdate at = follow(1);
  EXPECT_TRUE(at.relocalized);
  EXPECT_LT(at.max_current_weight, 0.5);  // of before it was put there
  const MclUpdate next = follow(1);
  EXPECT_FALSE(next.relocalized);
  EXPECT_LT(error_m(next), 0.1);
}

TEST_F(MclTest, IsTheSameForTheSameSeedAndNotForAnother) {
  start_at_the_truth();
  Mcl same = filter_;
  Mcl other(room(), {}, kSeed + 1);
  other.start_at(*seen_.true_pose);
  for (int i = 0; i < 10; ++i) {
    const Pose before = *seen_.scan.odometry;
    see();
    const Pose moved = inverse(before) * *seen_.scan.odometry;
    const auto a = *filter_.update(seen_.scan, moved);
    const auto b = *same.update(seen_.scan, moved);
    const auto c = *other.update(seen_.scan, moved);
    ASSERT_EQ(a.T_map_base, b.T_map_base);
    ASSERT_EQ(a.measurement_entropy, b.measurement_entropy);
    ASSERT_NE(a.T_map_base, c.T_map_base);
  }
  EXPECT_TRUE(std::ranges::equal(filter_.particles(), same.particles()));
}

TEST_F(MclTest, OnlyMovesWhereAScanSawNothing) {
  start_at_the_truth();
  Scan blind = seen_.scan;
  std::ranges::fill(blind.ranges_m, std::numeric_limits<float>::infinity());
  EXPECT_FALSE(filter_.update(blind, {1.0, 0.0, 0.0}).has_value());
  Pose mean;
  for (const Pose& particle : filter_.particles()) {
    mean.x_m += particle.x_m / static_cast<double>(filter_.particles().size());
    mean.y_m += particle.y_m / static_cast<double>(filter_.particles().size());
  }
  EXPECT_NEAR(distance_m(mean, *seen_.true_pose), 1.0, 0.05);
  filter_.start_anywhere(blind);
  EXPECT_GT(distance_m(filter_.particles()[0], filter_.particles()[1]), 0.0);
}

TEST_F(MclTest, KeepsItsWeightsNormalised) {
  start_at_the_truth();
  for (int i = 0; i < 30; ++i) {
    const MclUpdate update = follow(1);
    double sum = 0.0;
    for (const double weight : filter_.weights()) sum += weight;
    ASSERT_NEAR(sum, 1.0, 1e-9);
    ASSERT_GE(update.effective, 1.0 - 1e-9);
    ASSERT_LE(update.effective, 2000.0 + 1e-6);
    ASSERT_LE(update.measurement_entropy, std::log(2000.0) + 1e-9);
  }
}

TEST_F(MclTest, SurvivesBeingBeyondTheMap) {
  see();
  filter_.start_at({1e6, -1e6, 0.0});
  const MclUpdate update = follow(5);
  EXPECT_NEAR(update.max_current_weight, room().config().random_share, 1e-6);
  EXPECT_NEAR(update.measurement_entropy, std::log(2000.0), 1e-6);
}

TEST_F(MclTest, GathersWhereTheScansFit) {
  see();
  filter_.start_at(*seen_.true_pose, {0.8, 0.3});
  const MclUpdate update = follow(20);
  EXPECT_TRUE(std::ranges::all_of(filter_.particles(), [&](const Pose& particle) {
    return distance_m(particle, update.T_map_base) < 0.3;
  }));
}

TEST(MclByBeams, Tracks) {
  const sim::World world = sim::room_world();
  MeasurementConfig measurement;
  measurement.model = MeasurementModel::beam;
  measurement.beams = 30;
  const MeasuredMap map(floor_of(world), measurement);
  MclConfig config;
  config.particles = 300;
  Mcl filter(map, config, kSeed);
  sim::Drive drive(world, {}, kSeed, {});
  RecordedScan seen = drive.next(0.2);
  filter.start_at(*seen.true_pose);
  for (int i = 0; i < 40; ++i) {
    const Pose before = *seen.scan.odometry;
    seen = drive.next(0.2);
    const auto update = filter.update(seen.scan, inverse(before) * *seen.scan.odometry);
    ASSERT_LT(distance_m(update->T_map_base, *seen.true_pose), 0.15);
    ASSERT_GT(update->max_current_weight, 0.6);
  }
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
