// SPDX-License-Identifier: Apache-2.0
// What was written is found again.
#include "storage/archive.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

using core::IncidentKind;
using core::IncidentState;
using core::RobotState;
using core::Stamp;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class ArchiveTest : public testing::Test {
 protected:
  void add(const std::string& robot, const core::Score& score) {
    writer_.add_score(robot, score, score.stamp + std::chrono::milliseconds(30));
  }
  void put(const core::Incident& incident, std::optional<core::ScanPair> evidence = {}) {
    writer_.put_incident({.incident = incident, .evidence = std::move(evidence)});
  }
  const Archive& written() {
    writer_.flush().get();
    return archive_;
  }

  StoreFolder folder_;
  Writer writer_{{.file = folder_.store()}};
  Archive archive_{folder_.store(), writer_.recent()};
};

std::vector<std::string> ids(const std::vector<core::Incident>& incidents) {
  std::vector<std::string> ids;
  ids.reserve(incidents.size());
  for (const auto& incident : incidents) ids.push_back(incident.id);
  return ids;
}

TEST_F(ArchiveTest, AScoreComesBackInEveryField) {
  auto warming_up = score_at(1, 0.75, RobotState::unknown);
  warming_up.threshold.reset();
  warming_up.dissimilarity.standardized = false;
  add("robot-1", warming_up);
  add("robot-1", score_at(2, 99.0, RobotState::kidnapped));
  EXPECT_EQ(written().scores("robot-1", Stamp::min(), Stamp::max(), 10),
            (std::vector{warming_up, score_at(2, 99.0, RobotState::kidnapped)}));
}

TEST_F(ArchiveTest, ScoresAreThoseOfTheRobotAndTheRangeOldestFirst) {
  for (const int i : {5, 3, 1, 4, 2}) add("robot-1", score_at(i));
  add("robot-2", score_at(3.5));
  const auto scores = written().scores("robot-1", at_s(2), at_s(5), 100);
  EXPECT_EQ(scores, (std::vector{score_at(2), score_at(3), score_at(4)}));
  EXPECT_EQ(archive_.scores("robot-1", at_s(2), at_s(5), 2),
            (std::vector{score_at(2), score_at(3)}));
  EXPECT_TRUE(archive_.scores("robot-3", Stamp::min(), Stamp::max(), 100).empty());
}

TEST_F(ArchiveTest, AnIncidentComesBackInEveryField) {
  auto incident = incident_of(1);
  incident.kind = IncidentKind::carry;
  incident.cause = core::Cause::slip;
  incident.state = IncidentState::resolved;
  incident.resolved_at = at_s(77);
  incident.acknowledged_by = "ann";
  incident.resolved_by = "bob";
  incident.shelved_until = at_s(78);
  incident.label = core::IncidentLabel::false_alarm;
  incident.comment = "a \"forklift\"";
  put(incident);
  EXPECT_EQ(written().incident(incident.id), incident);
  EXPECT_EQ(archive_.incident("no-such-id"), std::nullopt);
}

TEST_F(ArchiveTest, AnIncidentChanges) {
  auto incident = incident_of(1);
  put(incident);
  incident.seq = 2;
  incident.state = IncidentState::acknowledged;
  put(incident);
  EXPECT_EQ(written().incidents({}), std::vector{incident});
}

TEST_F(ArchiveTest, IncidentsAreFilteredNewestFirst) {
  for (int i = 1; i <= 6; ++i) {
    auto incident = incident_of(i, i % 2 == 0 ? "even" : "odd");
    if (i > 4) incident.state = IncidentState::acknowledged;
    if (i == 1) incident.state = IncidentState::resolved;
    if (i == 3) incident.kind = IncidentKind::carry;
    if (i == 2) incident.label = core::IncidentLabel::test;
    put(incident);
  }
  const auto found = [this](const IncidentFilter& filter) {
    std::string numbers;
    for (const auto& id : ids(written().incidents(filter))) numbers += id.at(12);
    return numbers;
  };
  EXPECT_EQ(found({}), "654321");
  EXPECT_EQ(found({.robot = "even"}), "642");
  EXPECT_EQ(found({.state = IncidentState::acknowledged}), "65");
  EXPECT_EQ(found({.kind = IncidentKind::carry}), "3");
  EXPECT_EQ(found({.label = core::IncidentLabel::test}), "2");
  EXPECT_EQ(found({.opened_from = at_s(2), .opened_to = at_s(5)}), "432");
  EXPECT_EQ(found({.limit = 2}), "65");
  EXPECT_EQ(found({.before_id = incident_id(5), .limit = 2}), "43");
  EXPECT_EQ(found({.robot = "odd", .state = IncidentState::open, .before_id = incident_id(5)}),
            "3");
  std::string unresolved;
  for (const auto& id : ids(archive_.unresolved_incidents())) unresolved += id.at(12);
  EXPECT_EQ(unresolved, "65432");
}

core::ScanPair scans_around(double seconds) {
  const core::ScanGeometry lidar{-M_PI, 2 * M_PI / 5, 0.1, 30.0};
  return {.before = {at_s(seconds - 0.2), lidar, {1.5F, 0.0F, kNan, kInf, -kInf}, {}},
          .after = {at_s(seconds),
                    lidar,
                    {std::numeric_limits<float>::denorm_min(), 29.9F, 1.0F / 3.0F},
                    core::Pose{1.25, -3.5, 0.1}}};
}

TEST_F(ArchiveTest, EvidenceComesBackToTheBit) {
  const auto scans = scans_around(100);
  put(incident_of(1), scans);
  const auto evidence = written().evidence(incident_id(1));
  ASSERT_TRUE(evidence);
  EXPECT_EQ(evidence->scans.before.stamp, scans.before.stamp);
  EXPECT_EQ(evidence->scans.before.geometry, scans.before.geometry);
  EXPECT_EQ(evidence->scans.before.odometry, std::nullopt);
  EXPECT_EQ(evidence->scans.after.odometry, scans.after.odometry);
  EXPECT_EQ(evidence->scans.after.ranges_m, scans.after.ranges_m);
  const auto& ranges = evidence->scans.before.ranges_m;
  ASSERT_EQ(ranges.size(), 5U);
  EXPECT_TRUE(std::isnan(ranges[2]));
  EXPECT_EQ(ranges[3], kInf);
  EXPECT_EQ(ranges[4], -kInf);
}

TEST_F(ArchiveTest, EvidenceHoldsTheScoresAroundTheJump) {
  for (int i = 80; i <= 120; ++i) add("robot-1", score_at(i));
  add("robot-2", score_at(100));
  put(incident_of(1), scans_around(100));
  const auto evidence = written().evidence(incident_id(1));
  ASSERT_TRUE(evidence);
  ASSERT_EQ(evidence->scores.size(), 20U);  // 89.8 <= t < 110
  EXPECT_EQ(evidence->scores.front(), score_at(90));
  EXPECT_EQ(evidence->scores.back(), score_at(109));
}

TEST_F(ArchiveTest, OnlyTheFirstEvidenceIsKept) {
  put(incident_of(1), scans_around(100));
  put(incident_of(1), scans_around(200));
  EXPECT_EQ(written().evidence(incident_id(1))->scans.after.stamp, at_s(100));
}

TEST_F(ArchiveTest, NoEvidenceIsNothing) {
  put(incident_of(1));
  EXPECT_FALSE(written().evidence(incident_id(1)));
  EXPECT_FALSE(archive_.evidence("no-such-id"));
}

TEST_F(ArchiveTest, ConfigurationsAreListedNewestFirst) {
  EXPECT_TRUE(archive_.latest_configs().empty());
  const auto config = [](std::int64_t version, const char* text, const char* robot) {
    return ConfigText{
        .version = version, .since = at_s(version), .author = "eve", .text = text, .robot = robot};
  };
  const std::vector all{config(1, "{\"a\":1}", ""), config(2, "ü", "r1"), config(3, "{}", ""),
                        config(4, "{}", "r2")};
  for (const auto& one : all) writer_.add_config(one).get();
  EXPECT_EQ(archive_.latest_configs(), (std::vector{all[1], all[2], all[3]}));
  EXPECT_EQ(archive_.configs({}), (std::vector{all[3], all[2], all[1], all[0]}));
  EXPECT_EQ(archive_.configs({.robot = "r1"}), (std::vector{all[1]}));
  EXPECT_EQ(archive_.configs({.robot = ""}), (std::vector{all[2], all[0]}));
  EXPECT_EQ(archive_.configs({.before = 4, .limit = 2}), (std::vector{all[2], all[1]}));
}

TEST_F(ArchiveTest, RobotsTakeUpWhereTheyStopped) {
  add("robot-b", score_at(1, 5.0, RobotState::normal));
  for (int i = 1; i <= 4; ++i) add("robot-a", score_at(i, i, RobotState::normal));
  add("robot-a", score_at(5, 50.0, RobotState::suspect));
  add("robot-a", score_at(6, 60.0, RobotState::kidnapped));
  add("robot-a", score_at(7, 7.0, RobotState::unknown));
  const auto robots = written().robots(3);
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[0].robot, "robot-a");
  EXPECT_EQ(robots[0].latest, score_at(7, 7.0, RobotState::unknown));
  EXPECT_EQ(robots[0].last_arrival, at_s(7.03));
  EXPECT_EQ(robots[0].natural_scores, (std::vector{3.0, 4.0, 7.0}));
  EXPECT_EQ(robots[1].natural_scores, std::vector{5.0});
}

}  // namespace
}  // namespace kidnapwatch::storage
