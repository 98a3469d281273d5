// SPDX-License-Identifier: Apache-2.0
// Real logs: the same run from two formats is the same. Skipped where the logs are absent.
#include <cmath>

#include "adapters/logs/log.hpp"
#include "core/recording.hpp"
#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

struct Pair {
  std::string scan_text;
  std::string original;
  bool same_odometry;  ///< else the common format has none, or rounds differently
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
      ASSERT_NEAR(a.scan.ranges_m[beam], b.scan.ranges_m[beam], 1e-5) << i << ", " << beam;
    }
    EXPECT_NEAR(a.scan.geometry.angle_min_rad, b.scan.geometry.angle_min_rad, 1e-6);
    EXPECT_NEAR(a.scan.geometry.angle_increment_rad, b.scan.geometry.angle_increment_rad, 1e-6);
    EXPECT_EQ(a.scan.geometry.range_max_m, b.scan.geometry.range_max_m);
    if (!GetParam().same_odometry) continue;
    ASSERT_NEAR(distance_m(*a.scan.odometry, *b.scan.odometry), 0.0, 2e-3) << i;
    ASSERT_NEAR(core::wrapped(a.scan.odometry->theta_rad - b.scan.odometry->theta_rad), 0.0, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Logs, RecordedTwice,
    ::testing::Values(
        Pair{"radish_intel/radish_intel.scan.gz", "radish_intel/original/intel-corrected.log.gz",
             true},
        Pair{"radish_aces/radish_aces.scan.gz", "radish_aces/original/aces-corrected.log.gz", true},
        Pair{"radish_belgioioso/radish_belgioioso.scan.gz",
             "radish_belgioioso/original/belgioioso-corrected.log.gz", true},
        Pair{"radish_infinite_corridor/radish_infinite_corridor.scan.gz",
             "radish_infinite_corridor/original/infinite-corridor-corrected.log.gz", true},
        Pair{"csail_robotlaser1/csail_robotlaser1.scan.gz", "csail_robotlaser1/original/csail.log",
             false},
        Pair{"cmu_wean/cmu_wean_robotdata1.scan.gz", "cmu_wean/original/robotdata1.log.gz", true}),
    [](const auto& pair) {
      return pair.param.scan_text.substr(0, pair.param.scan_text.find('/'));
    });

}  // namespace
}  // namespace kidnapwatch::adapters::logs
