// SPDX-License-Identifier: Apache-2.0
// What is encoded reads back as it was.
#include "adapters/codecs/scan_encode.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/adapters/codecs/scans.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

std::string json(const core::Scan& scan, NonFinite non_finite = NonFinite::null) {
  std::string out;
  append_json(out, scan, non_finite);
  return out;
}

TEST(ScanEncode, WritesWhatRosbridgeWrites) {
  core::Scan scan = some_scan({1.5F, kInf, kNaN, 0.1F});
  scan.odometry = core::Pose{1.0, -2.0, 0.25};
  EXPECT_EQ(json(scan),
            R"({"header":{"stamp":{"sec":1700000000,"nanosec":123456789},"frame_id":"laser"},)"
            R"("angle_min":-1.5,"angle_max":-1.47,"angle_increment":0.01,"range_min":0.05,)"
            R"("range_max":12,"ranges":[1.5,null,null,0.1],"odom":{"x":1,"y":-2,"theta":0.25}})");
}

TEST(ScanEncode, WritesBareNonfiniteNumbersIfAsked) {
  EXPECT_NE(json(some_scan({kInf, -kInf, kNaN}), NonFinite::bare).find("[Infinity,-Infinity,NaN]"),
            std::string::npos);
}

TEST(ScanEncode, SplitsStampsBefore1970TowardsThePast) {
  core::Scan scan = some_scan({1.0F});
  scan.stamp = core::stamp_from_ns(-1);
  EXPECT_NE(json(scan).find(R"({"sec":-1,"nanosec":999999999})"), std::string::npos);
}

TEST(ScanEncode, AppendsToWhatIsThere) {
  std::string out = "before";
  append_json(out, some_scan({1.0F}));
  EXPECT_EQ(out, "before" + json(some_scan({1.0F})));
}

RC_GTEST_PROP(ScanEncode, ReadsBackFromJson, ()) {
  const core::Scan scan = arbitrary_scan();
  RC_ASSERT(same(decoded(json(scan, NonFinite::bare)), scan));
}

RC_GTEST_PROP(ScanEncode, ReadsBackFromJsonWithNullForNonfinite, ()) {
  core::Scan scan = arbitrary_scan();
  const std::string text = json(scan);
  for (float& range_m : scan.ranges_m) {
    range_m = std::isfinite(range_m) ? range_m : kInf;
  }
  RC_ASSERT(same(decoded(text), scan));
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
