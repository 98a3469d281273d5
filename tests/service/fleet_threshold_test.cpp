// SPDX-License-Identifier: Apache-2.0
// The fleet's median: what it is, and that no robot's threshold is below it.
#include "service/fleet_threshold.hpp"

#include <deque>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/service/fake_world.hpp"

namespace kidnapwatch::service {
namespace {

TEST(FleetThreshold, IsTheMedianOfWhatFiveRobotsOrMoreTold) {
  FleetThreshold fleet;
  for (const char* robot : {"a", "b", "c", "d"}) fleet.tell(robot, 3.0);
  fleet.tell("a", 9.0);  // a robot counts once
  EXPECT_EQ(fleet.median(), 0.0);
  fleet.tell("e", 5.0);
  EXPECT_EQ(fleet.median(), 3.0);
  fleet.tell("b", 7.0);
  EXPECT_EQ(fleet.median(), 5.0);
  fleet.tell("f", 6.0);
  EXPECT_EQ(fleet.median(), 5.0);  // of two in the middle the lower
}

TEST(FleetThreshold, TakesWhatManyThreadsTell) {
  FleetThreshold fleet;
  std::vector<std::thread> lanes;
  lanes.reserve(4);
  for (int lane = 0; lane < 4; ++lane) {
    lanes.emplace_back([&fleet, lane] {
      for (int i = 0; i <= 100; ++i) {
        fleet.tell(std::to_string(lane) + "-" + std::to_string(i % 5), i);
        (void)fleet.median();
      }
    });
  }
  for (auto& lane : lanes) lane.join();
  EXPECT_EQ(fleet.median(), 98.0);  // each lane's last: 96 .. 100
}

core::ConfigVersion by_motion() {
  core::ConfigVersion version;
  version.config.motion.threshold_min = 0.5;  // that the fleet is what decides
  version.config.calibration.warmup_pairs = 60;
  return version;
}

/// Robots that drive one after the other, on one thread.
class FleetOfWatches : public ::testing::Test {
 protected:
  Surroundings around() {
    return {.announcer = heard_,
            .now = [this] { return now_; },
            .uptime = [this] { return now_; },
            .new_id = [](core::Stamp) { return std::string("id"); },
            .config = [this](const std::string&) { return config_; },
            .log_refusal = [](const std::string&, const core::BadInput&) {}};
  }
  void drive(Watch& watch, int scans) {
    for (int i = 0; i < scans; ++i) {
      now_ = core::later_by_s(now_, 0.2);
      const double stamp_s = core::elapsed_s(core::Stamp{}, now_);
      watch.take(test::message(test::round_room(2.0, stamp_s), now_), bench_);
    }
  }
  /// Five robots that have just warmed up: of few pairs, they think little certain.
  void drive_novices(const Surroundings& around) {
    for (const char* robot : {"a", "b", "c", "d", "e"}) {
      drive(fleet_.emplace_back(robot, around), 64);
      fleet_.back().keep_learned();
    }
  }

  test::Heard heard_;
  core::Stamp now_ = test::at_s(100.0);
  std::shared_ptr<const core::ConfigVersion> config_ =
      std::make_shared<const core::ConfigVersion>(by_motion());
  Bench bench_{{.max_payload_bytes = 10'000}};
  std::deque<Watch> fleet_;
};

TEST_F(FleetOfWatches, NoRobotsThresholdIsBelowTheMedian) {
  const Surroundings one_fleet = around();
  Watch veteran("veteran", one_fleet);
  drive(veteran, 400);
  const double own = veteran.status().own_motion_threshold.value_or(0.0);
  EXPECT_EQ(veteran.status().motion_threshold, own);  // no fleet yet
  drive_novices(one_fleet);
  drive(veteran, 1);
  const core::RobotStatus status = veteran.status();
  EXPECT_GT(one_fleet.fleet_threshold->median(), own + 0.2);
  EXPECT_NEAR(status.motion_threshold.value_or(0.0), one_fleet.fleet_threshold->median(), 1e-6);
  EXPECT_NEAR(status.own_motion_threshold.value_or(0.0), own, 0.1);
  drive(veteran, 1);
  EXPECT_EQ(veteran.status().score->motion->threshold, status.motion_threshold);  // as published
}

TEST_F(FleetOfWatches, HasItsMedianAgainAfterARestart) {
  const Surroundings before = around();
  drive_novices(before);
  const Surroundings after = around();
  for (const auto& [robot, learned] : heard_.learned()) {
    Watch(robot, after).resume({.learned = learned});
  }
  EXPECT_GT(after.fleet_threshold->median(), 1.0);
  EXPECT_NEAR(after.fleet_threshold->median(), before.fleet_threshold->median(), 0.1);
}

TEST_F(FleetOfWatches, AsksForNoneOfTheRobotsWhereThePapersScoreDecides) {
  auto by_paper = by_motion();
  by_paper.config.alarm = core::AlarmBy::qs2ddtw;
  config_ = std::make_shared<const core::ConfigVersion>(by_paper);
  const Surroundings one_fleet = around();
  drive_novices(one_fleet);
  EXPECT_FALSE(fleet_.back().status().motion_threshold);
  EXPECT_EQ(one_fleet.fleet_threshold->median(), 0.0);
}

}  // namespace
}  // namespace kidnapwatch::service
