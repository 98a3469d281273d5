// SPDX-License-Identifier: Apache-2.0
// Robots as they were recorded, which no detector should take for kidnapped. Skipped where the logs
// are absent.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "adapters/logs/log.hpp"
#include "core/session.hpp"

namespace kidnapwatch::service {
namespace {

struct Seen {
  std::size_t changes = 0;   ///< of incidents
  std::size_t degraded = 0;  ///< scans after which it was
  core::RobotState last = core::RobotState::unknown;
};

/// What a session with the configuration as shipped makes of a log.
Seen watched(const std::filesystem::path& log) {
  core::Session session{core::DetectionConfig{}};
  core::DissimilarityWorkspace workspace;
  Seen seen;
  for (auto& recorded : adapters::logs::read_log(log).recording.scans) {
    const core::Stamp now = recorded.scan.stamp;
    const auto verdict = session.observe(recorded.scan, now, workspace).verdict;
    seen.changes += verdict && verdict->change ? 1 : 0;
    seen.last = session.state(now);
    seen.degraded += seen.last == core::RobotState::degraded ? 1 : 0;
  }
  return seen;
}

std::filesystem::path log_of(const std::string& name) {
  return std::filesystem::path(KW_DATA) / (name + ".scan.gz");
}

TEST(RecordedRobots, AStandingOneRaisesNothing) {
  const auto file = log_of("rplidar_a1_static/rplidar_a1_static");
  if (!exists(file)) GTEST_SKIP() << "no log " << file;
  const Seen seen = watched(file);
  EXPECT_EQ(seen.changes, 0U);
  EXPECT_EQ(seen.last, core::RobotState::normal);
}

class NearlyBlindRobots : public ::testing::TestWithParam<std::string> {};

TEST_P(NearlyBlindRobots, AreDegradedAndNotKidnapped) {
  const auto file = log_of(GetParam());
  if (!exists(file)) GTEST_SKIP() << "no log " << file;
  const Seen seen = watched(file);
  EXPECT_EQ(seen.changes, 0U);
  EXPECT_GT(seen.degraded, 50U);
  EXPECT_EQ(seen.last, core::RobotState::degraded);
}

INSTANTIATE_TEST_SUITE_P(YdlidarX4, NearlyBlindRobots,
                         ::testing::Values("ydlidar_x4_broombot/ydlidar_x4_3828",
                                           "ydlidar_x4_broombot/ydlidar_x4_3914",
                                           "ydlidar_x4_broombot/ydlidar_x4_4250",
                                           "ydlidar_x4_broombot/ydlidar_x4_4415"));

}  // namespace
}  // namespace kidnapwatch::service
