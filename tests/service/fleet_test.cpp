// SPDX-License-Identifier: Apache-2.0
// Many robots on few lanes: nothing is lost uncounted, and nobody starves.
#include "service/fleet.hpp"

#include <future>
#include <numeric>
#include <thread>

#include <gtest/gtest.h>

#include "tests/service/fake_world.hpp"

namespace kidnapwatch::service {
namespace {

using core::Outcome;
using test::round_room;

core::Stamp fixed_now() { return test::at_s(1000.0); }

class FleetTest : public ::testing::Test {
 protected:
  Fleet::Outside outside(const core::ConfigVersion& config = {}) {
    return {.announcer = heard_,
            .now = fixed_now,
            .uptime = fixed_now,
            .new_id = [](core::Stamp) { return std::string("id"); },
            .log_refusal = [](const std::string&, const core::BadInput&) {},
            .config = [shared = std::make_shared<const core::ConfigVersion>(config)](
                          const std::string&) { return shared; }};
  }
  /// All of one robot.
  static std::uint64_t counted(const Fleet& fleet, const std::string& robot, Outcome outcome) {
    return fleet.robot(robot)->counts.at(static_cast<std::size_t>(outcome));
  }
  std::uint64_t counted(const Fleet& fleet, Outcome outcome) {
    core::ServiceStatus status;
    fleet.describe(status);
    return status.counts.at(static_cast<std::size_t>(outcome));
  }

  test::Heard heard_;
};

TEST_F(FleetTest, CountsEveryMessageOfManyPublishersOnce) {
  Fleet fleet({.lanes = 2, .lane = {.queue_per_robot = 8}}, outside(test::with_threshold(60.0)));
  constexpr int kPublishers = 4;
  constexpr int kScans = 200;
  std::vector<std::thread> publishers;
  publishers.reserve(kPublishers);
  for (int p = 0; p < kPublishers; ++p) {
    publishers.emplace_back([&, p] {
      for (int i = 0; i < kScans; ++i) {
        const std::string robot = "r" + std::to_string((p + i) % 7);
        fleet.receive(robot,
                      test::message(i % 5 == 0 ? "garbage" : round_room(2.0, i), fixed_now()));
      }
    });
  }
  for (auto& publisher : publishers) {
    publisher.join();
  }
  fleet.stop();
  core::ServiceStatus status;
  fleet.describe(status);
  EXPECT_EQ(std::accumulate(status.counts.begin(), status.counts.end(), std::uint64_t{0}),
            std::uint64_t{kPublishers} * kScans);
  const auto& judged = status.judging.counts();
  EXPECT_EQ(std::accumulate(judged.begin(), judged.end(), std::uint64_t{0}),
            std::uint64_t{kPublishers} * kScans - counted(fleet, Outcome::overload));
  EXPECT_EQ(status.robots, 7U);
  EXPECT_EQ(status.queued_scans, 0U);
}

/// Holds the lane in the first alert or score until it is let go.
class Held : public test::Heard {
 public:
  void announce_score(const std::string& robot, const core::Score& score,
                      core::Stamp arrival) override {
    Heard::announce_score(robot, score, arrival);
    if (!std::exchange(holding_, true)) {
      reached_.set_value();
      let_go_.get_future().wait();
    }
  }
  std::promise<void> reached_;
  std::promise<void> let_go_;

 private:
  bool holding_ = false;
};

TEST_F(FleetTest, ARobotAboveItsRateIsCutAndTheOthersAreNot) {
  Fleet fleet({.lanes = 1, .lane = {.queue_per_robot = 10'000, .scans_per_s = 10}},
              outside(test::with_threshold(60.0)));
  for (int i = 0; i < 5000; ++i) {
    fleet.receive("loud", test::message(round_room(2.0, i), fixed_now()));
  }
  fleet.receive("calm", test::message(round_room(2.0, 1.0), fixed_now()));
  fleet.stop();
  EXPECT_GT(counted(fleet, "loud", Outcome::overload), 0U);
  EXPECT_EQ(counted(fleet, "loud", Outcome::overload) + counted(fleet, "loud", Outcome::first) +
                counted(fleet, "loud", Outcome::scored),
            5000U);
  EXPECT_EQ(counted(fleet, "calm", Outcome::first), 1U);
  EXPECT_EQ(counted(fleet, "calm", Outcome::overload), 0U);
}

TEST_F(FleetTest, AFullQueueDropsTheSameRobotsOldestAndServesTheOthers) {
  Held held;
  auto around = outside(test::with_threshold(60.0));
  Fleet fleet({.lanes = 1, .lane = {.queue_per_robot = 4}},
              {held, around.now, around.uptime, around.new_id, around.log_refusal, around.config});
  fleet.receive("loud", test::message(round_room(2.0, 1.0), fixed_now()));
  fleet.receive("loud", test::message(round_room(2.0, 2.0), fixed_now()));
  held.reached_.get_future().wait();  // the lane is busy with the second scan
  for (int i = 3; i < 13; ++i) {
    fleet.receive("loud", test::message(round_room(2.0, i), fixed_now()));
  }
  fleet.receive("calm", test::message(round_room(2.0, 1.0), fixed_now()));
  held.let_go_.set_value();
  fleet.stop();
  EXPECT_EQ(counted(fleet, Outcome::overload), 6U);
  EXPECT_EQ(held.scores().back().stamp, test::at_s(12.0));  // the newest are kept
  EXPECT_EQ(held.scores()[1].reference, test::at_s(2.0));
  EXPECT_EQ(held.scores()[1].stamp, test::at_s(9.0));
  EXPECT_EQ(fleet.robot("calm")->counts.at(static_cast<std::size_t>(Outcome::first)), 1U);
}

TEST_F(FleetTest, AnOrderIsCarriedOutHoweverManyScansComeAfterIt) {
  Held held;
  auto around = outside(test::with_threshold(60.0));
  Fleet fleet({.lanes = 1, .lane = {.queue_per_robot = 4}},
              {held, around.now, around.uptime, around.new_id, around.log_refusal, around.config});
  fleet.receive("loud", test::message(round_room(2.0, 1.0), fixed_now()));
  fleet.receive("loud", test::message(round_room(2.0, 2.0), fixed_now()));
  held.reached_.get_future().wait();  // the lane is busy with the second scan
  std::vector<std::future<void>> done;
  const auto order = [&] {
    const auto promise = std::make_shared<std::promise<void>>();
    done.push_back(promise->get_future());
    EXPECT_TRUE(fleet.order("loud", [promise](Watch&) { promise->set_value(); }));
  };
  for (int i = 0; i < 4; ++i) order();
  for (int i = 3; i < 13; ++i) {
    fleet.receive("loud", test::message(round_room(2.0, i), fixed_now()));
  }
  order();  // one more than there is room for
  held.let_go_.set_value();
  fleet.stop();
  for (int i = 0; i < 4; ++i) EXPECT_NO_THROW(done.at(i).get());
  EXPECT_THROW(done.at(4).get(), std::future_error);
  EXPECT_EQ(counted(fleet, "loud", Outcome::overload), 10U);
}

TEST_F(FleetTest, ItIsScansThatMakeARobot) {
  Fleet fleet({.lanes = 1}, outside());
  Message particles = test::message("[1]", fixed_now());
  particles.kind = MessageKind::particles;
  fleet.receive("r1", particles);
  EXPECT_FALSE(fleet.robot("r1"));
  fleet.receive("r1", test::message(round_room(2.0, 1.0), fixed_now()));
  fleet.receive("r1", particles);
  fleet.stop();
  EXPECT_EQ(counted(fleet, Outcome::first), 1U);
}

TEST_F(FleetTest, RefusesStrangeNamesAndTooManyRobots) {
  Fleet fleet({.lanes = 1, .max_robots = 2}, outside());
  for (const char* robot : {"a", "b", "c", "", "sp ace", "a/b"}) {
    fleet.receive(robot, test::message(round_room(2.0, 1.0), fixed_now()));
  }
  fleet.count(Outcome::unknown_topic);
  fleet.stop();
  EXPECT_EQ(counted(fleet, Outcome::first), 2U);
  EXPECT_EQ(counted(fleet, Outcome::too_many_robots), 1U);
  EXPECT_EQ(counted(fleet, Outcome::bad_robot_id), 3U);
  EXPECT_EQ(counted(fleet, Outcome::unknown_topic), 1U);
  EXPECT_FALSE(fleet.robot("c"));
}

TEST_F(FleetTest, ResumesRobotsOfAnEarlierRun) {
  core::ConfigVersion by_the_paper;
  by_the_paper.config.alarm = core::AlarmBy::qs2ddtw;
  Fleet fleet({.lanes = 1}, outside(by_the_paper));
  fleet.resume("old", {.natural_scores = std::vector<double>(200, 10.0)});
  EXPECT_EQ(fleet.robot("old")->calibration_pairs, 200U);
  EXPECT_EQ(fleet.robot("old")->threshold, 10.0);
}

TEST_F(FleetTest, KeepsWhatItLearnedForTheNextRun) {
  Fleet fleet({.lanes = 1}, outside());
  for (int i = 0; i < 40; ++i) {
    fleet.receive("r1", test::message(round_room(2.0, i), fixed_now()));
  }
  fleet.stop();
  const auto pairs = fleet.robot("r1")->calibration_pairs;
  EXPECT_GT(pairs, 30U);
  Fleet next({.lanes = 1}, outside());
  next.resume("r1", {.learned = heard_.learned().at("r1")});
  EXPECT_EQ(next.robot("r1")->calibration_pairs, pairs);
}

}  // namespace
}  // namespace kidnapwatch::service
