// SPDX-License-Identifier: Apache-2.0
// Real logs: the same run from two formats is the same. Skipped where the logs are absent.
#include <cmath>

#include "adapters/logs/log.hpp"
#include "core/recording.hpp"
#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

constexpr float kRounding = 0.00051F;  // m; the common format keeps millimetres

struct Pair {
  std::string scan_text;
  std::string original;
  bool same_odometry = true;  ///< else the common format has none
  bool same_frame = true;     ///< else the common format turned the beams into the base's frame
};

class RecordedTwice : public ::testing::TestWithParam<Pair> {};

TEST_P(RecordedTwice, IsTheSameRun) {
  const std::filesystem::path data(KW_DATA);
  if (!exists(data / GetParam().original)) GTEST_SKIP() << "no logs at " << data;
  const Log text = read_log(data / GetParam().scan_text);
  const Log original = read_log(data / GetParam().original);
  EXPECT_EQ(text.skipped_lines, 0U);
  EXPECT_EQ(original.skipped_lines, 0U) << original.first_skipped;
  ASSERT_EQ(text.recording.scans.size(), original.recording.scans.size());
  for (std::size_t i = 0; i < text.recording.scans.size(); ++i) {
    const core::RecordedScan& a = text.recording.scans[i];
    const core::RecordedScan& b = original.recording.scans[i];
    ASSERT_EQ(a.scan.ranges_m.size(), b.scan.ranges_m.size());
    for (std::size_t beam = 0; beam < a.scan.ranges_m.size(); ++beam) {
      const float range_a = a.scan.ranges_m[beam];
      const float range_b = b.scan.ranges_m[beam];
      if (std::isnan(range_a) && std::isnan(range_b)) continue;
      if (range_a == range_b) continue;  // infinity
      ASSERT_NEAR(range_a, range_b, kRounding) << i << ", " << beam;
    }
    if (GetParam().same_frame) {
      ASSERT_NEAR(a.scan.geometry.angle_min_rad, b.scan.geometry.angle_min_rad, 1e-6);
    }
    ASSERT_NEAR(a.scan.geometry.angle_increment_rad, b.scan.geometry.angle_increment_rad, 1e-6);
    ASSERT_NEAR(a.scan.geometry.range_max_m, b.scan.geometry.range_max_m, 1e-6);
    if (!GetParam().same_odometry) continue;
    ASSERT_NEAR(distance_m(*a.scan.odometry, *b.scan.odometry), 0.0, 2e-3) << i;
    ASSERT_NEAR(core::wrapped(a.scan.odometry->theta_rad - b.scan.odometry->theta_rad), 0.0, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Logs, RecordedTwice,
    ::testing::Values(
        Pair{"radish_intel/radish_intel.scan.gz", "radish_intel/original/intel-corrected.log.gz"},
        Pair{"radish_aces/radish_aces.scan.gz", "radish_aces/original/aces-corrected.log.gz"},
        Pair{"radish_belgioioso/radish_belgioioso.scan.gz",
             "radish_belgioioso/original/belgioioso-corrected.log.gz"},
        Pair{"radish_infinite_corridor/radish_infinite_corridor.scan.gz",
             "radish_infinite_corridor/original/infinite-corridor-corrected.log.gz"},
        Pair{"csail_robotlaser1/csail_robotlaser1.scan.gz", "csail_robotlaser1/original/csail.log",
             false},
        Pair{"cmu_wean/cmu_wean_robotdata1.scan.gz", "cmu_wean/original/robotdata1.log.gz"},
        Pair{"neato_olin/neato_olin_left_side.scan.gz", "neato_olin/original/left_side.bag", true,
             false},
        Pair{"neato_halls/neato_halls_wall_mk.scan.gz",
             "neato_halls/original/mary-keenan__wall_follower.bag", true, false},
        Pair{"sim_tb3_fuse/sim_tb3_fuse.scan.gz", "sim_tb3_fuse/original/turtlebot3.bag"},
        Pair{"guardian_hokuyo/guardian_hokuyo_front_guardian_3.scan.gz",
             "guardian_hokuyo/original/guardian_3.bag"}),
    [](const auto& pair) {
      return pair.param.scan_text.substr(0, pair.param.scan_text.find('/'));
    });

}  // namespace
}  // namespace kidnapwatch::adapters::logs
