// SPDX-License-Identifier: Apache-2.0
// NDT's four scores: on a drive, at a kidnapping, and against the corrected poses of real logs.
#include "core/baselines/ndt_scores.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include "adapters/logs/log.hpp"
#include "core/sim/drive.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kStepS = 0.5;

sim::RobotModel far_sighted() {
  sim::RobotModel robot;
  robot.range_max_m = 8.0;
  return robot;
}

TEST(ScanMatcher, FollowsASimulatedDrive) {
  const sim::World world = sim::room_world();
  sim::Drive drive(world, far_sighted(), 3, Stamp{});
  ScanMatcher matcher({});
  Pose before;
  for (int i = 0; i < 100; ++i) {
    const RecordedScan recorded = drive.next(kStepS);
    const auto scores = matcher.observe(recorded.scan);
    EXPECT_EQ(scores.has_value(), i > 0);
    if (scores) {
      const Pose off = inverse(inverse(before) * *recorded.true_pose) * *matcher.motion();
      EXPECT_LT(std::hypot(off.x_m, off.y_m), 0.05) << i;
      EXPECT_LT(std::abs(off.theta_rad), 0.03) << i;
    }
    before = *recorded.true_pose;
  }
}

TEST(ScanMatcher, AsksTheFrameOfTheLidar) {
  const sim::World world = sim::room_world();
  const Pose T_base_lidar{0.2, -0.1, 1.0};
  const sim::Fan fan(360);
  const Pose T_map_base{4.0, 3.0, 0.4};
  const Pose T_before_now{0.1, 0.02, 0.15};
  const auto scan_at = [&](const Pose& base, double t_s) {
    Scan scan{later_by_s(Stamp{}, t_s), {0.0, fan.increment_rad, 0.05, 8.0}, {}, base};
    for (const double range_m : sim::sweep(world, base * T_base_lidar, fan, 8.0)) {
      scan.ranges_m.push_back(static_cast<float>(range_m));
    }
    return scan;
  };
  ScanMatcher matcher({}, T_base_lidar);
  ASSERT_FALSE(matcher.observe(scan_at(T_map_base, 0.0)));
  const auto scores = matcher.observe(scan_at(T_map_base * T_before_now, 0.5));
  ASSERT_TRUE(scores);
  EXPECT_LT(scores->qo, 0.02);  // odometry is perfect here
  EXPECT_LT(distance_m(*matcher.motion(), T_before_now), 0.02);
}

TEST(NdtDetectors, AllSeeAKidnappingToAnotherRoom) {
  const sim::World room = sim::room_world();
  const sim::World corridor = sim::corridor_world();
  sim::Drive here(room, far_sighted(), 3, Stamp{});
  sim::Drive there(corridor, far_sighted(), 4, later_by_s(Stamp{}, 30 * kStepS));
  const auto detectors = ndt_detectors();
  ASSERT_EQ(detectors.size(), 4U);
  std::vector<double> most(detectors.size(), -1e9);  // raised, while it drives
  for (int i = 0; i < 30; ++i) {
    const Scan scan = here.next(kStepS).scan;
    for (std::size_t d = 0; d < detectors.size(); ++d) {
      const auto score = detectors[d]->observe(scan);
      if (score) most[d] = std::max(most[d], raised(*score, detectors[d]->polarity()));
    }
  }
  const Scan scan = there.next(kStepS).scan;
  for (std::size_t d = 0; d < detectors.size(); ++d) {
    if (detectors[d]->name() == "ndt_qh") continue;  // tells how sure the match is of itself
    const double score = *detectors[d]->observe(scan);
    EXPECT_GT(raised(score, detectors[d]->polarity()), most[d]) << detectors[d]->name();
  }
}

TEST(NdtDetectors, SayNothingOfScansThatCannotBeCompared) {
  const auto detectors = ndt_detectors();
  Scan scan{Stamp{}, {0.0, 0.0174, 0.1, 3.5}, std::vector<float>(360, 0.0F), std::nullopt};
  EXPECT_FALSE(detectors[0]->observe(scan));
  EXPECT_FALSE(detectors[1]->observe(scan));
}

struct Log {
  std::string file;
  Pose T_base_lidar;
  double median_m;  ///< what the median error may be
  double median_rad;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

class RecordedPairs : public ::testing::TestWithParam<Log> {};

TEST_P(RecordedPairs, AreRegisteredAsTheCorrectedPosesSay) {
  const std::filesystem::path file = std::filesystem::path(KW_DATA) / GetParam().file;
  if (!exists(file)) GTEST_SKIP() << "no log at " << file;
  const auto recording = adapters::logs::read_log(file).recording;
  ScanMatcher matcher({}, GetParam().T_base_lidar);
  std::vector<double> errors_m;
  std::vector<double> errors_rad;
  const RecordedScan* before = nullptr;
  for (const RecordedScan& recorded : recording.scans) {
    const auto scores = matcher.observe(recorded.scan);
    if (scores && before != nullptr && recorded.true_pose && before->true_pose) {
      const Pose off =
          inverse(inverse(*before->true_pose) * *recorded.true_pose) * *matcher.motion();
      errors_m.push_back(std::hypot(off.x_m, off.y_m));
      errors_rad.push_back(std::abs(off.theta_rad));
    }
    if (is_comparable(recorded.scan)) before = &recorded;
  }
  ASSERT_GT(errors_m.size(), 100U);
  std::cout << GetParam().file << ": " << errors_m.size() << " pairs, median error "
            << median(errors_m) << " m, " << median(errors_rad) << " rad\n";
  EXPECT_LT(median(errors_m), GetParam().median_m);
  EXPECT_LT(median(errors_rad), GetParam().median_rad);
}

INSTANTIATE_TEST_SUITE_P(
    Logs, RecordedPairs,
    ::testing::Values(Log{"cmu_wean/cmu_wean_robotdata3.scan.gz", {0.25, 0.0, 0.0}, 0.02, 0.005},
                      Log{"radish_intel/radish_intel.scan.gz", {}, 0.05, 0.015},
                      Log{"radish_aces/radish_aces.scan.gz", {}, 0.06, 0.01}),
    [](const auto& log) { return log.param.file.substr(0, log.param.file.find('/')); });

}  // namespace
}  // namespace kidnapwatch::core::baselines
