// SPDX-License-Identifier: Apache-2.0
// The common text format, read as written.
#include "adapters/logs/scan_text.hpp"

#include <cmath>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using ScanTextTest = LogFileTest;

constexpr std::string_view kText =
    "# hall -1.5 0.75 3 5.6\n"
    "0.25 1 2 0.5 4 5 -0.5 0.9 0 inf\n"
    "0.45 nan nan nan nan nan nan nan 5.6 1e-1\n";

TEST_F(ScanTextTest, IsReadAsWritten) {
  const Log log = read_log(gzipped("any.name", kText));
  EXPECT_EQ(log.skipped_lines, 0U);
  EXPECT_EQ(log.recording.name, "hall");
  ASSERT_EQ(log.recording.scans.size(), 2U);
  const core::RecordedScan& first = log.recording.scans[0];
  EXPECT_EQ(first.scan.geometry, (core::ScanGeometry{-1.5, 0.75, 0.0, 5.6}));
  EXPECT_EQ(first.scan.odometry, (core::Pose{1, 2, 0.5}));
  EXPECT_EQ(first.true_pose, (core::Pose{4, 5, -0.5}));
  EXPECT_EQ(first.scan.ranges_m, (std::vector<float>{0.9F, 0.0F, INFINITY}));
  EXPECT_EQ(core::ns_since_epoch(first.scan.stamp), 250'000'000);
  const core::RecordedScan& second = log.recording.scans[1];
  EXPECT_FALSE(second.scan.odometry);
  EXPECT_FALSE(second.true_pose);
  EXPECT_TRUE(std::isnan(second.scan.ranges_m[0]));
  EXPECT_FALSE(core::is_valid(second.scan.ranges_m[1], second.scan.geometry));
}

TEST_F(ScanTextTest, SkipsAndCountsBrokenLines) {
  const auto file = plain("b.scan", std::string(kText) +
                                        "0.6 1 2 3 4 5 6 1 2\n"         // a range short
                                        "0.7 1 2 3 4 5 6 1 2 3 4\n"     // one too many
                                        "soon 1 2 3 4 5 6 1 2 3\n"      // no time
                                        "inf 1 2 3 4 5 6 1 2 3\n"       // nor this
                                        "\n"                            // nothing
                                        "0.8 1 2 3 4 5 6 1 2 3\n" +     // good
                                        std::string("\0\x01\xff", 3));  // no text
  const Log log = read_log(file);
  EXPECT_EQ(log.recording.scans.size(), 3U);
  EXPECT_EQ(log.skipped_lines, 6U);
  EXPECT_EQ(log.first_skipped, file.string() + ":4: ranges: missing");
}

TEST(ScanText, IsToldByItsHeader) {
  EXPECT_TRUE(is_scan_text("# hall 0 0.0175 360 3.5\n0 0 0"));
  EXPECT_TRUE(is_scan_text("# hall 0 0.0175 360 3.5\r\n"));
  EXPECT_FALSE(is_scan_text(""));
  EXPECT_FALSE(is_scan_text("# message formats defined: PARAM SYNC ODOM FLASER\n"));
  EXPECT_FALSE(is_scan_text("# hall 0 0.0175 0 3.5\n"));
  EXPECT_FALSE(is_scan_text("# hall 0 0.0175 360 3.5 7\n"));
}

TEST_F(ScanTextTest, WithAnImpossibleLidarHasNoUsableScan) {
  EXPECT_NE(refused(plain("a", "# hall 0 0 3 5\n0 1 2 3 4 5 6 1 2 3\n")).find("no usable scan"),
            std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
