// SPDX-License-Identifier: Apache-2.0
// Scores, incidents and evidence, spelled.
#include "adapters/codecs/history_json.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "adapters/codecs/messages.hpp"
namespace kidnapwatch::adapters::codecs {
namespace {

core::Stamp at_s(std::int64_t seconds) { return core::stamp_from_ns(seconds * 1'000'000'000); }

core::Score score() {
  return {.stamp = at_s(2),
          .reference = at_s(1),
          .dissimilarity = {.cost = 72.5, .cost_per_beam = 0.1, .standardized = false},
          .threshold = 180.0,
          .state = core::RobotState::normal};
}

TEST(HistoryJson, SpellsAScore) {
  EXPECT_EQ(text(json(score())),
            R"({"time":"1970-01-01T00:00:02.000000000Z",)"
            R"("referenceTime":"1970-01-01T00:00:01.000000000Z","score":72.5,"scorePerBeam":0.1,)"
            R"("standardized":false,"threshold":180.0,"state":"normal"})");
}

TEST(HistoryJson, LeavesOutAThresholdThatIsNotThereYet) {
  auto warming_up = score();
  warming_up.threshold.reset();
  EXPECT_FALSE(json(warming_up).contains("threshold"));
}

TEST(HistoryJson, SpellsWhatOtherDetectorsSaidOfAScan) {
  auto with_others = score();
  with_others.others = {{core::detector_id("ndt_qs", ""), 0.1F},
                        {core::detector_id("me", ""), std::numeric_limits<float>::infinity()}};
  EXPECT_EQ(text(json(with_others)["detectors"]), R"({"ndt_qs":0.1})");
  const std::vector scores{score(), with_others};
  const std::string csv = scores_csv(scores);
  EXPECT_EQ(csv.substr(0, csv.find("\r\n")),
            "time,referenceTime,score,scorePerBeam,standardized,threshold,state,ndt_qs,me");
  EXPECT_NE(csv.find("180,normal,,\r\n"), std::string::npos);
  EXPECT_NE(csv.find("180,normal,0.1,\r\n"), std::string::npos);
}

TEST(HistoryJson, SpellsMotionInCsvWhereThereIsAny) {
  auto moving = score();
  moving.motion = core::MotionScore{.score = 1.5, .confirmed = -2.0, .carry = 0.25};
  const std::string csv = scores_csv(std::vector{score(), moving});
  EXPECT_NE(csv.find("state,motion,motionConfirmed,motionThreshold,carry\r\n"), std::string::npos);
  EXPECT_NE(csv.find("180,normal,,,,\r\n"), std::string::npos);
  EXPECT_NE(csv.find("180,normal,1.5,-2,,0.25\r\n"), std::string::npos);
}

TEST(HistoryJson, SpellsAnIncident) {
  const core::Incident incident{.id = "0190",
                                .robot = "r1",
                                .seq = 2,
                                .kind = core::IncidentKind::teleport,
                                .state = core::IncidentState::resolved,
                                .opened_at = at_s(10),
                                .resolved_at = at_s(20),
                                .scan_stamp = at_s(3),
                                .before_stamp = at_s(1),
                                .after_stamp = at_s(2),
                                .detector = "qs2ddtw",
                                .score = 500.0,
                                .threshold = 180.0,
                                .config_version = 4};
  EXPECT_EQ(
      text(json(incident)),
      R"({"id":"0190","robotId":"r1","seq":2,"kind":"teleport",)"
      R"("cause":"teleport","state":"resolved",)"
      R"("openedAt":"1970-01-01T00:00:10.000000000Z",)"
      R"("resolvedAt":"1970-01-01T00:00:20.000000000Z",)"
      R"("beforeTime":"1970-01-01T00:00:01.000000000Z",)"
      R"("afterTime":"1970-01-01T00:00:02.000000000Z",)"
      R"("scanTime":"1970-01-01T00:00:03.000000000Z","detector":"qs2ddtw","score":500.0,)"
      R"("threshold":180.0,"explanation":"Nothing the lidar sees matches what it saw before.",)"
      R"("configVersion":4})");
}

TEST(HistoryJson, LeavesOutWhenAnOpenIncidentWasResolved) {
  EXPECT_FALSE(json(core::Incident{}).contains("resolvedAt"));
}

TEST(HistoryJson, SpellsScansAsLaserScanWithNullForMisses) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  core::Evidence evidence;
  evidence.scans.before = {.stamp = core::stamp_from_ns(-1),
                           .geometry = {-1.0, 0.5, 0.12, 3.5},
                           .ranges_m = {1.2F, inf, nan, -inf, 0.0F},
                           .odometry = core::Pose{1.0, 2.0, 0.5}};
  evidence.scores = {score()};
  const Json spelled = parsed(evidence_json(evidence, {}), "evidence");
  EXPECT_EQ(
      text(spelled["before"]),
      R"({"header":{"stamp":{"sec":-1,"nanosec":999999999},"frame_id":"laser"},"angle_min":-1,)"
      R"("angle_max":1,"angle_increment":0.5,"range_min":0.12,"range_max":3.5,)"
      R"("ranges":[1.2,null,null,null,0],"odom":{"x":1,"y":2,"theta":0.5}})");
  EXPECT_FALSE(spelled["after"].contains("odom"));
  EXPECT_EQ(spelled["scores"], Json::array({json(score())}));
}

TEST(HistoryJson, WritesRangesThatReadBackAsTheSameFloats) {
  core::Evidence evidence;
  for (float range_m = 0.001F; range_m < 100.0F; range_m *= 1.37F) {
    evidence.scans.after.ranges_m.push_back(range_m);
  }
  const auto read = parsed(evidence_json(evidence, {}), "evidence")["after"]["ranges"];
  EXPECT_EQ(read.get<std::vector<float>>(), evidence.scans.after.ranges_m);
}

TEST(HistoryJson, SpellsWhatTheDetectorsSaw) {
  const core::Sight sight{
      .warping =
          core::Warping{.cost = 1.5, .standardized = false, .steps = {{0, 0, 0.5}, {1, 0, 1.0}}},
      .motion = core::MotionSight{.told = core::Pose{0.25, 0.0, 0.0},
                                  .seen = {1.0, 2.0, 0.5},
                                  .violating_before = {3},
                                  .violating_after = {}}};
  const Json spelled = parsed(evidence_json({}, sight), "evidence");
  EXPECT_EQ(text(spelled["warping"]),
            R"({"cost":1.5,"standardized":false,"steps":[[0,0,0.5],[1,0,1.0]]})");
  EXPECT_EQ(text(spelled["motion"]),
            R"({"seen":{"x":1.0,"y":2.0,"theta":0.5},"told":{"x":0.25,"y":0.0,"theta":0.0},)"
            R"("violating":{"before":[3],"after":[]}})");
  EXPECT_FALSE(parsed(evidence_json({}, {}), "evidence").contains("warping"));
}

TEST(HistoryJson, SpellsTheLastScansAsFarAsThereAreSome) {
  const core::Scan scan{.geometry = {-1.0, 0.5, 0.12, 3.5}, .ranges_m = {1.2F}};
  EXPECT_EQ(scans_json({}), "{}");
  EXPECT_EQ(parsed(scans_json(std::vector{scan}), "scans").size(), 1U);
  const Json both = parsed(scans_json(std::vector{scan, scan}), "scans");
  EXPECT_EQ(both["before"], both["after"]);
}

TEST(HistoryJson, TellsOfAChangeWhoDidWhatWhen) {
  core::Alert alert{.event_id = "e", .type = core::AlertType::acknowledged, .author = "ada"};
  alert.incident.seq = 2;
  alert.incident.comment = "a forklift";
  EXPECT_EQ(text(change_json(alert_message(alert))),
            R"({"time":"1970-01-01T00:00:00.000000000Z","author":"ada","action":"acknowledged",)"
            R"("seq":2,"state":"open","comment":"a forklift"})");
}

TEST(HistoryJson, WritesIncidentsAsCsv) {
  core::Incident incident{.id = "i1", .robot = "r1", .seq = 2, .detector = "qs2ddtw", .score = 7.5};
  incident.comment = "a \"forklift\",\nit says";
  incident.acknowledged_by = "=ada()";
  const auto csv = incidents_csv(std::vector{incident});
  EXPECT_TRUE(csv.starts_with("id,robotId,seq,kind,")) << csv;
  EXPECT_NE(csv.find("\r\ni1,r1,2,teleport,teleport,open,1970-01-01T00:00:00.000000000Z,,"),
            std::string::npos)
      << csv;
  EXPECT_TRUE(csv.ends_with(",'=ada(),,,,\"a \"\"forklift\"\",\nit says\"\r\n")) << csv;
  EXPECT_TRUE(incidents_csv({}).ends_with("label,comment\r\n"));
}

TEST(HistoryJson, WritesScoresAsCsv) {
  auto second = score();
  second.threshold.reset();
  const std::vector<core::Score> scores{score(), second};
  EXPECT_EQ(scores_csv(scores),
            "time,referenceTime,score,scorePerBeam,standardized,threshold,state\r\n"
            "1970-01-01T00:00:02.000000000Z,1970-01-01T00:00:01.000000000Z,72.5,0.1,false,180,"
            "normal\r\n"
            "1970-01-01T00:00:02.000000000Z,1970-01-01T00:00:01.000000000Z,72.5,0.1,false,,"
            "normal\r\n");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
