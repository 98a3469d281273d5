// SPDX-License-Identifier: Apache-2.0
// Kidnappings and confounders: each is what its name says, and nothing else.
#include <cmath>

#include <gtest/gtest.h>

#include "core/evaluation/confounders.hpp"
#include "core/evaluation/kidnaps.hpp"
#include "tests/core/evaluation/tour.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

const Recording& run() {
  static const Recording recording = tour(400);
  return recording;
}

constexpr std::size_t kAt = 250;
constexpr std::size_t kCount = 8;

/// Index of the recorded scan whose ranges these are; the number of scans if there is none.
std::size_t source(const Scan& scan) {
  std::size_t i = 0;
  while (i < run().scans.size() && run().scans[i].scan.ranges_m != scan.ranges_m) ++i;
  return i;
}

double moved_m(const Episode& episode) {
  return distance_m(*run().scans[source(episode.scans.front())].true_pose,
                    *run().scans[episode.at].true_pose);
}

void expect_told_as_recorded(const Episode& episode) {
  const Pose told =
      inverse(*run().scans[episode.at - 1].scan.odometry) * *episode.scans.front().odometry;
  const Pose recorded = told_motion(run(), episode.at - 1, episode.at);
  EXPECT_NEAR(distance_m(told, recorded), 0.0, 1e-9);
  EXPECT_NEAR(wrapped(told.theta_rad - recorded.theta_rad), 0.0, 1e-9);
}

TEST(Kidnapped, GoesAsFarAsItsNameSays) {
  Random random(1);
  for (const auto& [kind, least_m, most_m] : {std::tuple{Kidnap::far, 4.0, 99.0},
                                              {Kidnap::look_alike, 2.0, 99.0},
                                              {Kidnap::move_025m, 0.2, 0.3},
                                              {Kidnap::move_05m, 0.4, 0.6},
                                              {Kidnap::move_1m, 0.8, 1.2},
                                              {Kidnap::move_2m, 1.6, 2.4}}) {
    const auto episode = kidnapped(run(), kind, kAt, kCount, random);
    ASSERT_TRUE(episode) << name(kind);
    EXPECT_EQ(episode->scans.size(), kCount);
    EXPECT_GE(moved_m(*episode), least_m) << name(kind);
    EXPECT_LE(moved_m(*episode), most_m) << name(kind);
    expect_told_as_recorded(*episode);
  }
}

TEST(Kidnapped, GoesOnInTheSensorsTime) {
  Random random(1);
  const auto episode = kidnapped(run(), Kidnap::far, kAt, kCount, random);
  ASSERT_TRUE(episode);
  for (std::size_t i = 0; i < kCount; ++i)
    EXPECT_EQ(episode->scans[i].stamp, run().scans[kAt + i].scan.stamp);
}

TEST(Kidnapped, TurnsWholeTurnScansOnTheSpot) {
  Random random(1);
  const auto episode = kidnapped(run(), Kidnap::turn_90deg, kAt, kCount, random);
  ASSERT_TRUE(episode);
  const auto& as_recorded = run().scans[kAt].scan.ranges_m;
  const auto& turned = episode->scans.front().ranges_m;
  const bool left = turned[0] == as_recorded[45];
  EXPECT_TRUE(left || turned[0] == as_recorded[135]);
  EXPECT_EQ(turned[10], as_recorded[left ? 55 : 145]);
}

TEST(Kidnapped, WakesTenSecondsLaterAndFeltNothing) {
  Random random(1);
  const auto episode = kidnapped(run(), Kidnap::wake, kAt, kCount, random);
  ASSERT_TRUE(episode);
  EXPECT_NEAR(elapsed_s(run().scans[kAt].scan.stamp, episode->scans.front().stamp), 10.0, 1e-6);
  EXPECT_EQ(episode->scans.front().odometry, run().scans[kAt - 1].scan.odometry);
}

TEST(Kidnapped, SlipsInTheOdometryAlone) {
  Random random(1);
  for (const Kidnap kind : {Kidnap::slip_way, Kidnap::slip_turn}) {
    const auto episode = kidnapped(run(), kind, kAt, kCount, random);
    ASSERT_TRUE(episode);
    EXPECT_EQ(source(episode->scans.front()), kAt);
    const Pose recorded = *run().scans[kAt].scan.odometry;
    const Pose error = inverse(recorded) * *episode->scans.front().odometry;
    EXPECT_NEAR(std::abs(error.x_m), kind == Kidnap::slip_way ? 0.5 : 0.0, 1e-9);
    EXPECT_NEAR(std::abs(error.theta_rad), kind == Kidnap::slip_turn ? 0.5236 : 0.0, 1e-4);
  }
}

TEST(Kidnapped, CarriesWithStandingWheels) {
  Random random(1);
  const auto episode = kidnapped(run(), Kidnap::carry, kAt, 32, random);
  ASSERT_TRUE(episode);
  for (const Scan& scan : episode->scans)
    EXPECT_EQ(scan.odometry, run().scans[kAt - 1].scan.odometry);
}

TEST(Kidnapped, IsImpossibleWhereThereIsNoRoom) {
  Random random(1);
  EXPECT_FALSE(kidnapped(run(), Kidnap::far, 0, kCount, random));
  EXPECT_FALSE(kidnapped(run(), Kidnap::far, 398, kCount, random));
}

TEST(Confounded, MissesScansAndTellsTheWholeMotion) {
  Random random(1);
  const auto episode = confounded(run(), Confounder::gap_5, kAt, kCount, random);
  ASSERT_TRUE(episode);
  EXPECT_EQ(episode->at, kAt - 4);
  EXPECT_EQ(source(episode->scans.front()), kAt);
  EXPECT_EQ(episode->scans.front().odometry, run().scans[kAt].scan.odometry);
}

std::size_t changed(const Scan& scan, std::size_t recorded) {
  std::size_t beams = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i)
    beams += scan.ranges_m[i] != run().scans[recorded].scan.ranges_m[i] ? 1 : 0;
  return beams;
}

TEST(Confounded, ChangesWhatItsNameSaysForAsLong) {
  Random random(1);
  for (const auto& [kind, first, later] : {std::tuple{Confounder::popup, true, false},
                                           {Confounder::popup_stays, true, true},
                                           {Confounder::glitch, true, false},
                                           {Confounder::range_noise, true, true},
                                           {Confounder::beam_loss, true, true},
                                           {Confounder::people_5, true, true},
                                           {Confounder::bad_odometry, false, false},
                                           {Confounder::late_odometry, false, false}}) {
    const auto episode = confounded(run(), kind, kAt, kCount, random);
    ASSERT_TRUE(episode) << name(kind);
    EXPECT_EQ(changed(episode->scans.front(), kAt) > 0, first) << name(kind);
    EXPECT_EQ(changed(episode->scans[3], kAt + 3) > 0, later) << name(kind);
  }
}

TEST(Confounded, TellsEveryMotionTenPercentAndThreeDegreesOff) {
  Random random(1);
  const auto episode = confounded(run(), Confounder::bad_odometry, kAt, kCount, random);
  ASSERT_TRUE(episode);
  for (std::size_t i = 1; i < kCount; ++i) {
    const Pose told = inverse(*episode->scans[i - 1].odometry) * *episode->scans[i].odometry;
    const Pose recorded = told_motion(run(), kAt + i - 1, kAt + i);
    EXPECT_NEAR(std::abs(wrapped(told.theta_rad - recorded.theta_rad)), 0.05236, 1e-4);
  }
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
