// SPDX-License-Identifier: Apache-2.0
// Centimetres become metres.
#include "adapters/logs/cmu.hpp"

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using CmuTest = LogFileTest;

std::string laser_line(int beams, double t_s) {
  std::string line = "L 100 -200 0.5 125 -200 0.5";
  for (int i = 0; i < beams; ++i) line += " " + std::to_string(100 + i);
  return line + " " + std::to_string(t_s) + "\n";
}

TEST_F(CmuTest, IsReadInMetres) {
  const Log log = read_log(plain("robotdata.log", "O 0 0 0 0.01\n" + laser_line(180, 0.5) +
                                                      "O 0 0 0 0.6\n" + laser_line(180, 0.7)));
  EXPECT_EQ(log.skipped_lines, 0U);
  ASSERT_EQ(log.recording.scans.size(), 2U);
  const core::Scan& scan = log.recording.scans[0].scan;
  EXPECT_EQ(scan.odometry, (core::Pose{1, -2, 0.5}));
  ASSERT_EQ(scan.ranges_m.size(), 180U);
  EXPECT_FLOAT_EQ(scan.ranges_m[0], 1.0F);
  EXPECT_FLOAT_EQ(scan.ranges_m[179], 2.79F);
  EXPECT_EQ(core::ns_since_epoch(scan.stamp), 500'000'000);
}

TEST_F(CmuTest, SkipsLinesWithAnotherNumberOfBeams) {
  const Log log =
      read_log(plain("a", laser_line(180, 1) + laser_line(179, 2) + laser_line(181, 3) + "X 1\n"));
  EXPECT_EQ(log.recording.scans.size(), 1U);
  EXPECT_EQ(log.skipped_lines, 3U);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
