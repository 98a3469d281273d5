// SPDX-License-Identifier: Apache-2.0
// Odometry in both forms, and every way to be wrong.
#include "adapters/codecs/odometry_json.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/adapters/codecs/scans.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

// What rosbridge sends of nav_msgs/Odometry, shortened in its covariances.
constexpr const char* kRos =
    R"({"header":{"seq":1,"stamp":{"secs":5,"nsecs":6},"frame_id":"odom"},)"
    R"("child_frame_id":"base_link","pose":{"pose":{"position":{"x":1.5,"y":-2,"z":0.1},)"
    R"("orientation":{"x":0,"y":0,"z":0.7071067811865476,"w":0.7071067811865476}},)"
    R"("covariance":[0,null]},"twist":{"twist":{"linear":{"x":9,"y":9,"z":9}}}})";
constexpr const char* kShort = R"({"stamp":{"sec":5,"nanosec":6},"x":1.5,"y":-2,"theta":0.5})";

StampedPose odometry(std::string_view text) { return OdometryDecoder().decode(text); }

std::string bad_odometry(std::string_view text) {
  try {
    (void)odometry(text);
    return "decoded";
  } catch (const core::BadScan& bad) {
    return std::string(core::name(bad.outcome())) + " " + bad.what();
  }
}

TEST(OdometryJson, ReadsNavMsgsOdometry) {
  const StampedPose read = odometry(kRos);
  EXPECT_EQ(read.stamp, core::stamp_from_ns(5'000'000'006));
  EXPECT_EQ(read.pose.x_m, 1.5);
  EXPECT_EQ(read.pose.y_m, -2.0);
  EXPECT_DOUBLE_EQ(read.pose.theta_rad, std::numbers::pi / 2.0);
}

TEST(OdometryJson, ReadsTheShortForm) {
  const StampedPose expected{core::stamp_from_ns(5'000'000'006), {1.5, -2.0, 0.5}};
  EXPECT_EQ(odometry(kShort), expected);
}

TEST(OdometryJson, ReadsStampsInSeconds) {
  EXPECT_EQ(odometry(R"({"stamp":1700000000.25,"x":1,"y":2,"theta":3})").stamp,
            core::stamp_from_ns(1'700'000'000'250'000'000));
}

TEST(OdometryJson, PassesOverBareNanInCovariances) {
  EXPECT_EQ(odometry(replaced(kRos, "[0,null]", "[NaN,-Infinity]")).pose.x_m, 1.5);
}

TEST(OdometryJson, NamesWhatIsMissing) {
  EXPECT_EQ(bad_odometry("{}"), "missing_field stamp: is missing");
  EXPECT_EQ(bad_odometry(replaced(kRos, "position", "p")), "missing_field x: is missing");
  EXPECT_EQ(bad_odometry(replaced(kRos, "orientation", "o")), "missing_field theta: is missing");
  EXPECT_EQ(bad_odometry(replaced(kShort, "theta", "t")), "missing_field theta: is missing");
}

TEST(OdometryJson, NamesWhatIsWrong) {
  EXPECT_EQ(bad_odometry(replaced(kRos, R"("z":0.7071067811865476,"w":0.7071067811865476)",
                                  R"("z":0,"w":0)")),
            "wrong_type pose.pose.orientation: is not a rotation");
  EXPECT_EQ(bad_odometry(replaced(kRos, "-2", "null")),
            "wrong_type pose.pose.position: is not a number");
  EXPECT_EQ(bad_odometry(replaced(kRos, R"({"x":1.5,"y":-2,"z":0.1})", "[1,2]")),
            "wrong_type pose.pose.position: is not an object");
  EXPECT_TRUE(bad_odometry(replaced(kShort, "1.5", "NaN")).starts_with("wrong_type"));
  EXPECT_TRUE(bad_odometry(R"({"stamp":1e300,"x":1,"y":2,"theta":3})").starts_with("wrong_type"));
  EXPECT_TRUE(bad_odometry(R"({"stamp":"now","x":1,"y":2,"theta":3})").starts_with("wrong_type"));
  EXPECT_TRUE(bad_odometry("[1]").starts_with("malformed"));
  EXPECT_TRUE(bad_odometry("").starts_with("malformed"));
}

RC_GTEST_PROP(OdometryJson, TurnsQuaternionsOfAnyLength, ()) {
  const double yaw_rad = *rc::gen::inRange(-3141, 3142) * 1e-3;
  const double length = *rc::gen::inRange(1, 1000) * 0.1;
  const std::string text =
      R"({"header":{"stamp":{"sec":1,"nanosec":0}},"pose":{"pose":{"position":{"x":0,"y":0},)"
      R"("orientation":{"x":0,"y":0,"z":)" +
      std::to_string(length * std::sin(yaw_rad / 2.0)) + R"(,"w":)" +
      std::to_string(length * std::cos(yaw_rad / 2.0)) + "}}}}";
  RC_ASSERT(std::abs(odometry(text).pose.theta_rad - yaw_rad) < 1e-3);
}

RC_GTEST_PROP(OdometryJson, SurvivesMutations, ()) {
  (void)bad_odometry(mutated(*rc::gen::element<std::string>(kRos, kShort)));
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
