// SPDX-License-Identifier: Apache-2.0
// What the service says over MQTT, word by word.
#include "adapters/codecs/messages.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "adapters/codecs/json.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

constexpr auto kNow = core::stamp_from_ns(1'700'000'010'500'000'000);
constexpr auto kScan = core::stamp_from_ns(1'700'000'000'000'000'001);

core::Alert some_alert() {
  core::Alert alert;
  alert.event_id = "e-1";
  alert.type = core::AlertType::opened;
  alert.timestamp = kNow;
  alert.incident = {.id = "i-1",
                    .robot = "r1",
                    .seq = 1,
                    .kind = core::IncidentKind::teleport,
                    .state = core::IncidentState::open,
                    .opened_at = kNow,
                    .resolved_at = {},
                    .scan_stamp = kScan,
                    .before_stamp = kScan,
                    .after_stamp = kScan,
                    .detector = "qs2ddtw",
                    .score = 12.5,
                    .threshold = 3.0,
                    .config_version = 4};
  return alert;
}

TEST(AlertMessage, TellsTheFullState) {
  const Json message = parsed(alert_message(some_alert()), "alert");
  const Json expected = {{"schema", "kidnapwatch/alert/1"},
                         {"eventId", "e-1"},
                         {"incidentId", "i-1"},
                         {"seq", 1},
                         {"type", "opened"},
                         {"kind", "teleport"},
                         {"cause", "teleport"},
                         {"robotId", "r1"},
                         {"state", "open"},
                         {"severity", "critical"},
                         {"timestamp", "2023-11-14T22:13:30.500000000Z"},
                         {"scanStamp", {{"sec", 1700000000}, {"nanosec", 1}}},
                         {"detector", "qs2ddtw"},
                         {"score", 12.5},
                         {"threshold", 3.0},
                         {"explanation", "Nothing the lidar sees matches what it saw before."},
                         {"configVersion", 4},
                         {"links", {{"incident", "/api/v1/incidents/i-1"}}}};
  for (const auto& [key, value] : expected.items()) {
    ASSERT_TRUE(message.contains(key)) << key;
    EXPECT_EQ(message[key], value) << key;
  }
  EXPECT_FALSE(message.contains("resolvedAt"));
}

TEST(AlertMessage, CalmsDownWhenTheIncidentIsResolved) {
  core::Alert alert = some_alert();
  alert.type = core::AlertType::resolved;
  alert.incident.state = core::IncidentState::resolved;
  alert.incident.resolved_at = kNow;
  const Json message = parsed(alert_message(alert), "alert");
  EXPECT_EQ(message["severity"], "info");
  EXPECT_EQ(message["resolvedAt"], "2023-11-14T22:13:30.500000000Z");
}

TEST(AlertMessage, NeverHoldsNull) {
  core::Alert alert = some_alert();
  alert.incident.score = std::numeric_limits<double>::quiet_NaN();
  alert.incident.threshold = std::numeric_limits<double>::infinity();
  EXPECT_EQ(alert_message(alert).find("null"), std::string::npos);
}

TEST(StateMessage, TellsThresholdAndIncidentWhereKnown) {
  core::RobotStatus robot;
  robot.id = "r1";
  robot.state = core::RobotState::unknown;
  const Json warming_up = parsed(state_message(robot, kNow), "state");
  EXPECT_EQ(warming_up["schema"], "kidnapwatch/state/1");
  EXPECT_EQ(warming_up["robotId"], "r1");
  EXPECT_EQ(warming_up["state"], "unknown");
  for (const char* absent : {"threshold", "motionThreshold", "ownMotionThreshold"})
    EXPECT_FALSE(warming_up.contains(absent)) << absent;
  EXPECT_FALSE(warming_up.contains("incidentId"));
  robot.state = core::RobotState::kidnapped;
  robot.threshold = 3.5;
  robot.motion_threshold = 5.5;
  robot.own_motion_threshold = 4.25;
  robot.incident_id = "i-1";
  const Json kidnapped = parsed(state_message(robot, kNow), "state");
  EXPECT_EQ(kidnapped["state"], "kidnapped");
  EXPECT_EQ(kidnapped["threshold"], 3.5);
  EXPECT_EQ(kidnapped["motionThreshold"], 5.5);
  EXPECT_EQ(kidnapped["ownMotionThreshold"], 4.25);
  EXPECT_EQ(kidnapped["incidentId"], "i-1");
}

TEST(ScoreMessage, NamesTheRobot) {
  core::Score score;
  score.stamp = kScan;
  score.dissimilarity.cost = 1.5;
  const Json message = parsed(score_message("r1", score), "score");
  EXPECT_EQ(message["schema"], "kidnapwatch/score/1");
  EXPECT_EQ(message["robotId"], "r1");
  EXPECT_EQ(message["score"], 1.5);
}

TEST(ServiceStatusMessage, TellsSinceWhen) {
  const Json message = parsed(service_status_message("online", "1.2.3", kNow), "status");
  EXPECT_EQ(message["status"], "online");
  EXPECT_EQ(message["version"], "1.2.3");
  EXPECT_EQ(message["startedAt"], "2023-11-14T22:13:30.500000000Z");
  EXPECT_EQ(message["degraded"], Json::array());
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
