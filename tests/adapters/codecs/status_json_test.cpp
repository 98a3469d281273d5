// SPDX-License-Identifier: Apache-2.0
// Robots and the service, spelled.
#include "adapters/codecs/status_json.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace kidnapwatch::adapters::codecs {
namespace {

TEST(StatusJson, SpellsARobotThatWarmsUp) {
  core::RobotStatus robot;
  robot.id = "r1";
  robot.calibration_pairs = 3;
  robot.warmup_pairs = 100;
  robot.counts[static_cast<std::size_t>(core::Outcome::first)] = 1;
  const Json spelled = json(robot);
  EXPECT_EQ(spelled["id"], "r1");
  EXPECT_EQ(spelled["state"], "unknown");
  EXPECT_EQ(spelled["lastScanAt"], "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(text(spelled["calibration"]), R"({"pairs":3,"needed":100})");
  EXPECT_EQ(spelled["scans"]["first"], 1);
  for (const char* absent : {"incidentId", "threshold", "lastScore"}) {
    EXPECT_FALSE(spelled.contains(absent)) << absent;
  }
}

TEST(StatusJson, SpellsARobotWithAnOpenIncident) {
  core::RobotStatus robot;
  robot.state = core::RobotState::kidnapped;
  robot.score = core::Score{};
  robot.threshold = 180.0;
  robot.incident_id = "0190";
  const Json spelled = json(robot);
  EXPECT_EQ(spelled["state"], "kidnapped");
  EXPECT_EQ(spelled["incidentId"], "0190");
  EXPECT_EQ(spelled["threshold"], 180.0);
  EXPECT_EQ(spelled["lastScore"]["score"], 0.0);
}

TEST(StatusJson, CountsEveryOutcomeByItsName) {
  const Json spelled = json(core::ServiceStatus{});
  EXPECT_EQ(spelled["scans"].size(), core::kOutcomes);
  EXPECT_EQ(spelled["scans"]["out_of_order"], 0);
}

TEST(StatusJson, SpellsTheService) {
  core::ServiceStatus service;
  service.version = "0.1.0";
  service.robots = 2;
  service.broker_connected = true;
  service.queued_scans = 3;
  service.queued_writes = 4;
  service.lost_writes = 5;
  service.store_bytes = 6;
  service.degraded = {{"clock", "the clock jumped"}};
  Json spelled = json(service);
  spelled.erase("scans");
  EXPECT_EQ(spelled["commands"].size(), core::kCommandResults);
  EXPECT_EQ(spelled["commands"]["no_incident"], 0);
  spelled.erase("commands");
  EXPECT_EQ(text(spelled),
            R"({"version":"0.1.0","startedAt":"1970-01-01T00:00:00.000000000Z","robots":2,)"
            R"("brokerConnected":true,"storeHealthy":false,"queuedScans":3,"queuedWrites":4,)"
            R"("lostWrites":5,"storeBytes":6,)"
            R"("degraded":[{"name":"clock","what":"the clock jumped"}]})");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
