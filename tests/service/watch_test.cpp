// SPDX-License-Identifier: Apache-2.0
// One robot's payloads become counts, scores, states and alerts.
#include "service/watch.hpp"

#include <gtest/gtest.h>

#include "tests/service/fake_world.hpp"

namespace kidnapwatch::service {
namespace {

using core::Outcome;
using test::round_room;

class WatchTest : public ::testing::Test {
 protected:
  void send(const std::string& payload) { watch_.take(test::message(payload, now_), bench_); }

  void drive(double radius_m, int scans) {
    for (int i = 0; i < scans; ++i) {
      now_ = core::later_by_s(now_, 0.2);
      send(round_room(radius_m, core::elapsed_s(core::Stamp{}, now_)));
    }
  }

  std::uint64_t counted(Outcome outcome) {
    return watch_.status().counts.at(static_cast<std::size_t>(outcome));
  }

  test::Heard heard_;
  core::Stamp now_ = test::at_s(100.0);
  std::optional<core::Stamp> uptime_;  // as now_, unless it is set
  int ids_ = 0;
  std::shared_ptr<const core::ConfigVersion> config_ =
      std::make_shared<const core::ConfigVersion>(test::with_threshold(60.0));
  Surroundings around_{.announcer = heard_,
                       .now = [this] { return now_; },
                       .uptime = [this] { return uptime_ ? *uptime_ : now_; },
                       .new_id = [this](core::Stamp) { return std::to_string(++ids_); },
                       .config = [this](const auto&) { return config_; },
                       .log_refusal = [](const std::string&, const core::BadInput&) {}};
  Bench bench_{{.max_payload_bytes = 10'000}};
  Watch watch_{"r1", around_};
};

TEST_F(WatchTest, RaisesOneIncidentWhenTheRoomChanges) {
  drive(2.0, 3);
  drive(6.0, 5);
  const auto alerts = heard_.alerts();
  ASSERT_EQ(alerts.size(), 1U);
  EXPECT_EQ(alerts[0].type, core::AlertType::opened);
  EXPECT_EQ(alerts[0].incident.robot, "r1");
  EXPECT_EQ(alerts[0].incident.seq, 1U);
  EXPECT_GT(alerts[0].incident.score, alerts[0].incident.threshold);
  EXPECT_EQ(alerts[0].incident.threshold, 60.0);
  EXPECT_EQ(watch_.status().incident_id, alerts[0].incident.id);
  EXPECT_EQ(watch_.status().state, core::RobotState::kidnapped);
  const auto evidence = heard_.evidence();
  ASSERT_TRUE(evidence[0]);
  EXPECT_NEAR(evidence[0]->before.ranges_m[0], 2.0, 0.02);
  EXPECT_NEAR(evidence[0]->after.ranges_m[0], 6.0, 0.02);
  EXPECT_EQ(heard_.states(),
            (std::vector<std::string>{"r1 suspect", "r1 kidnapped"}));  // normal from the start
}

TEST_F(WatchTest, KeepsTheLastTwoGoodScans) {
  EXPECT_TRUE(watch_.last_scans().empty());
  drive(2.0, 1);
  ASSERT_EQ(watch_.last_scans().size(), 1U);
  drive(3.0, 1);
  send("no scan");
  const auto scans = watch_.last_scans();
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_NEAR(scans[0].ranges_m[0], 2.0, 0.02);
  EXPECT_NEAR(scans[1].ranges_m[0], 3.0, 0.02);
  EXPECT_LT(scans[0].stamp, scans[1].stamp);
  watch_.forget_scans();
  EXPECT_TRUE(watch_.last_scans().empty());
}

TEST_F(WatchTest, AnotherJumpUpdatesTheOpenIncidentAndRestResolvesIt) {
  drive(2.0, 3);
  drive(6.0, 3);
  drive(3.0, 160);
  const auto alerts = heard_.alerts();
  ASSERT_EQ(alerts.size(), 3U);
  EXPECT_EQ(alerts[1].type, core::AlertType::updated);
  EXPECT_EQ(alerts[2].type, core::AlertType::resolved);
  EXPECT_EQ(alerts[2].incident.id, alerts[0].incident.id);
  EXPECT_EQ(alerts[2].incident.seq, 3U);
  EXPECT_TRUE(alerts[2].incident.resolved_at);
  EXPECT_FALSE(watch_.status().incident_id);
  EXPECT_EQ(heard_.states().back(), "r1 normal");
}

TEST_F(WatchTest, CountsEveryKindOfBadScanUnderItsOwnReason) {
  drive(2.0, 2);
  send("\xff garbage");
  send(std::string(20'000, ' '));
  const std::string good = round_room(2.0, 200.0);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    return bad.replace(bad.find(from), from.size(), to);
  };
  send(good.substr(0, good.find("\"ranges\"")) + "\"ranges\":[]}");
  send(good.substr(0, good.find("\"ranges\"")) + "\"ranges\":\"far\"}");
  send(with("\"angle_increment\":0.069778", "\"angle_increment\":0"));
  send(with("\"angle_min\":0,", ""));
  send(good.substr(0, good.find("\"ranges\"")) + "\"ranges\":[NaN,NaN,NaN]}");
  drive(2.0, 1);
  for (const auto once :
       {Outcome::malformed, Outcome::too_large, Outcome::no_beams, Outcome::wrong_type,
        Outcome::bad_geometry, Outcome::missing_field, Outcome::not_comparable, Outcome::first}) {
    EXPECT_EQ(counted(once), 1U) << core::name(once);
  }
  EXPECT_EQ(counted(Outcome::scored), 2U);
}

TEST_F(WatchTest, TellsOnceThatARobotFellSilentAndOnceThatItIsBack) {
  drive(2.0, 2);
  now_ = core::later_by_s(now_, 4.9);
  watch_.tick();
  now_ = core::later_by_s(now_, 0.2);
  watch_.tick();
  watch_.tick();
  drive(2.0, 2);
  EXPECT_EQ(heard_.states(), (std::vector<std::string>{"r1 stale", "r1 normal"}));
}

TEST_F(WatchTest, AClockThatJumpsHidesNoSilenceAndInventsNone) {
  drive(2.0, 2);
  uptime_ = now_;
  now_ = core::later_by_s(now_, 2 * 86'400.0);
  watch_.tick();
  EXPECT_TRUE(heard_.states().empty());
  now_ = core::later_by_s(now_, -5 * 86'400.0);
  uptime_ = core::later_by_s(*uptime_, 5.1);
  watch_.tick();
  EXPECT_EQ(heard_.states(), std::vector<std::string>{"r1 stale"});
}

TEST_F(WatchTest, ANewConfigurationTakesEffectWithTheNextScan) {
  drive(2.0, 3);
  auto changed = test::with_threshold(1e6);
  changed.version = 7;
  config_ = std::make_shared<const core::ConfigVersion>(changed);
  drive(6.0, 3);
  EXPECT_TRUE(heard_.alerts().empty());
  EXPECT_EQ(watch_.status().threshold, 1e6);
}

TEST_F(WatchTest, ResumesAnOpenIncident) {
  core::Incident open{.id = "before", .robot = "r1", .seq = 4};
  watch_.resume({.natural_scores = {}, .open_incident = open});
  EXPECT_EQ(watch_.status().incident_id, "before");
  drive(2.0, 160);
  ASSERT_EQ(heard_.alerts().size(), 1U);
  EXPECT_EQ(heard_.alerts()[0].type, core::AlertType::resolved);
  EXPECT_EQ(heard_.alerts()[0].incident.seq, 5U);
}

TEST_F(WatchTest, RecordsTheDetectorsThatAreAskedForAndTheRobotsParticles) {
  auto changed = test::with_threshold(60.0);
  changed.version = 7;
  changed.config.detectors = {"ndt_qo", "mcw"};
  config_ = std::make_shared<const core::ConfigVersion>(changed);
  const auto tell = [&](const char* particles) {
    Message message = test::message(particles, now_);
    message.kind = MessageKind::particles;
    watch_.take(message, bench_);
  };
  drive(2.0, 1);
  tell("[0.5,0.25]");
  drive(2.0, 1);
  tell("garbage");
  drive(2.0, 1);
  const auto scores = heard_.scores();
  ASSERT_EQ(scores.size(), 2U);
  ASSERT_EQ(scores[0].others.size(), 2U);
  EXPECT_EQ(core::name(scores[0].others[0].detector), "ndt_qo");
  EXPECT_EQ(core::name(scores[0].others[1].detector), "mcw");
  EXPECT_EQ(scores[0].others[1].score, 0.5F);
  EXPECT_EQ(scores[1].others.size(), 1U);      // no particles since
  EXPECT_EQ(counted(Outcome::malformed), 0U);  // it counts scans
}

class IncidentOrders : public WatchTest {
 protected:
  IncidentOrders() {
    drive(2.0, 3);
    drive(6.0, 3);
  }

  /// The incident after it, as the robot's watch, or `stored`, has it.
  std::optional<core::Incident> order(core::IncidentAction action,
                                      const std::optional<core::Incident>& stored = {}) {
    Message message = test::message("", now_);
    core::IncidentCommand command{.action = action, .author = "ann"};
    command.shelve_for_s = 10.0;
    command.label = core::IncidentLabel::false_alarm;
    std::optional<core::Incident> changed;
    message.kind = MessageKind::order;
    message.order = [&](Watch& watch) {
      changed = watch.carry_out(stored.value_or(heard_.alerts().back().incident), command);
    };
    watch_.take(message, bench_);
    return changed;
  }

  std::string told() {
    std::string types;
    for (const auto& alert : heard_.alerts()) {
      types += std::string(core::name(alert.type)) + std::to_string(alert.incident.seq) + " ";
    }
    return types;
  }
};

TEST_F(IncidentOrders, AreToldInOrderWithTheirAuthor) {
  EXPECT_EQ(order(core::IncidentAction::ack)->acknowledged_by, "ann");
  EXPECT_EQ(order(core::IncidentAction::ack)->seq, 2U);  // changes nothing, and says nothing
  (void)order(core::IncidentAction::label);
  (void)order(core::IncidentAction::unack);
  EXPECT_EQ(told(), "opened1 acknowledged2 updated3 unacknowledged4 ");
  EXPECT_EQ(heard_.alerts()[1].author, "ann");
  EXPECT_EQ(heard_.alerts()[0].author, "kidnapwatch");
}

TEST_F(IncidentOrders, ResolveForTheRobotToo) {
  EXPECT_EQ(order(core::IncidentAction::resolve)->resolved_by, "ann");
  EXPECT_EQ(watch_.status().state, core::RobotState::normal);
  EXPECT_FALSE(watch_.status().incident_id);
  EXPECT_EQ(heard_.states().back(), "r1 normal");
  EXPECT_FALSE(order(core::IncidentAction::ack));
  drive(6.0, 160);
  EXPECT_EQ(told(), "opened1 resolved2 ");  // and is not resolved again by rule
}

TEST_F(IncidentOrders, AFurtherJumpTakesTheAcknowledgementBack) {
  (void)order(core::IncidentAction::ack);
  drive(2.0, 3);
  EXPECT_EQ(told(), "opened1 acknowledged2 updated3 ");
  EXPECT_EQ(heard_.alerts().back().incident.state, core::IncidentState::open);
  EXPECT_EQ(heard_.alerts().back().incident.acknowledged_by, "");
}

TEST_F(IncidentOrders, ShelvingEndsByItself) {
  EXPECT_TRUE(order(core::IncidentAction::shelve)->shelved_until);
  now_ = core::later_by_s(now_, 9.9);
  watch_.tick();
  now_ = core::later_by_s(now_, 0.2);
  watch_.tick();
  watch_.tick();
  EXPECT_EQ(told(), "opened1 shelved2 updated3 ");
  EXPECT_FALSE(heard_.alerts().back().incident.shelved_until);
}

TEST_F(IncidentOrders, OfAnEarlierIncidentLeaveTheRobotAlone) {
  core::Incident earlier{.id = "earlier", .robot = "r1", .seq = 7};
  EXPECT_EQ(order(core::IncidentAction::resolve, earlier)->seq, 8U);
  EXPECT_EQ(watch_.status().state, core::RobotState::kidnapped);
  EXPECT_EQ(told(), "opened1 resolved8 ");
}

TEST_F(IncidentOrders, KnowTheOpenIncident) {
  ASSERT_TRUE(watch_.open_incident());
  EXPECT_EQ(*watch_.open_incident(), heard_.alerts().back().incident);
  (void)order(core::IncidentAction::resolve);
  EXPECT_FALSE(watch_.open_incident());
}

TEST_F(WatchTest, ComparesWithNothingAfterItForgot) {
  drive(2.0, 3);
  watch_.forget_scans();
  drive(6.0, 3);
  EXPECT_TRUE(heard_.alerts().empty());
  EXPECT_EQ(counted(Outcome::first), 2U);
}

TEST_F(IncidentOrders, ForgettingScansLeavesTheIncidentOpen) {
  watch_.forget_scans();
  drive(2.0, 3);
  EXPECT_EQ(watch_.status().state, core::RobotState::kidnapped);
  EXPECT_EQ(told(), "opened1 ");
}

TEST_F(WatchTest, KeepsWhatItLearnedNowAndThen) {
  drive(2.0, 499);
  EXPECT_TRUE(heard_.learned().empty());
  drive(2.0, 1);
  EXPECT_EQ(heard_.learned().count("r1"), 1U);
}

std::string odometry(double stamp_s, double x) {
  return R"({"stamp":)" + std::to_string(stamp_s) + R"(,"x":)" + std::to_string(x) +
         R"(,"y":0,"theta":0})";
}

TEST_F(WatchTest, InterpolatesOdometryToTheScansTime) {
  const auto tell = [&](double at_s, double x) {
    Message message = test::message(odometry(at_s, x), now_);
    message.kind = MessageKind::odometry;
    watch_.take(message, bench_);
  };
  drive(2.0, 1);  // at 100.2 s
  tell(100.3, 0.0);
  tell(100.5, 1.0);
  drive(2.0, 1);
  drive(6.0, 2);
  const auto evidence = heard_.evidence();
  ASSERT_EQ(evidence.size(), 1U);
  const auto& scans = *evidence[0];
  ASSERT_TRUE(scans.before.odometry);
  EXPECT_NEAR(scans.before.odometry->x_m, 0.5, 1e-3);  // at 100.4 s
  EXPECT_NEAR(scans.after.odometry->x_m, 1.5, 1e-3);   // at 100.6 s, going on
}

TEST_F(WatchTest, RefusesBadOdometryWithoutCountingItAsAScan) {
  drive(2.0, 1);
  Message message = test::message("{garbage", now_);
  message.kind = MessageKind::odometry;
  watch_.take(message, bench_);
  EXPECT_EQ(counted(Outcome::malformed), 0U);
}

}  // namespace
}  // namespace kidnapwatch::service
