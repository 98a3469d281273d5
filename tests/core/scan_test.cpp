// SPDX-License-Identifier: Apache-2.0
// Which scans are refused, which beams count.
#include "core/scan.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/outcome.hpp"
#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kTurnRad = 2.0 * std::numbers::pi;

/// How check() refuses the scan: "field outcome", or "" if it does not.
std::string refusal(const Scan& scan) {
  try {
    check(scan);
  } catch (const BadScan& error) {
    return error.field() + " " + std::string(name(error.outcome()));
  }
  return "";
}

std::string refusal_of(ScanGeometry geometry) {
  return refusal({at_s(0.0), geometry, std::vector<float>(10, 1.0F), {}});
}

Scan with_valid_beams(std::size_t valid, std::size_t all) {
  Scan scan = round_room(1.0, at_s(0.0), all);
  std::fill(scan.ranges_m.begin() + static_cast<std::ptrdiff_t>(valid), scan.ranges_m.end(), kNan);
  return scan;
}

TEST(CheckScan, TakesOneTurnEitherWay) {
  EXPECT_EQ(refusal(round_room(1.0, at_s(0.0), 1)), "");
  EXPECT_EQ(refusal(round_room(1.0, at_s(0.0), kMaxBeams)), "");
  EXPECT_EQ(refusal_of({-kTurnRad, -kTurnRad / 10.0, 0.0, 0.1}), "");
}

TEST(CheckScan, TakesTheOneDegreeBeamThatAnXv11SendsTwice) {
  Scan scan = round_room(1.0, at_s(0.0), 360);
  scan.ranges_m.push_back(1.0F);
  EXPECT_EQ(refusal(scan), "");
  scan.geometry.angle_increment_rad = 0.01746;  // a degree as some drivers round it
  EXPECT_EQ(refusal(scan), "");
  scan.geometry.angle_increment_rad = 0.0178;
  EXPECT_EQ(refusal(scan), "angle_increment bad_geometry");
}

TEST(CheckScan, TakesRangesThatHitNothing) {
  Scan scan = round_room(1.0, at_s(0.0));
  scan.ranges_m = {kNan, kInfinity, -kInfinity, 0.0F, -1.0F};
  EXPECT_EQ(refusal(scan), "");
}

TEST(CheckScan, RefusesNoBeamsAndTooMany) {
  Scan scan = round_room(1.0, at_s(0.0));
  scan.ranges_m.clear();
  EXPECT_EQ(refusal(scan), "ranges no_beams");
  scan.ranges_m.resize(kMaxBeams + 1);
  EXPECT_EQ(refusal(scan), "ranges too_many_beams");
}

TEST(CheckScan, RefusesAnglesThatSweepNothingOrMoreThanATurn) {
  EXPECT_EQ(refusal_of({kNan, 0.1, 0.0, 1.0}), "angle_min bad_geometry");
  EXPECT_EQ(refusal_of({-kInfinity, 0.1, 0.0, 1.0}), "angle_min bad_geometry");
  for (const double increment_rad :
       {0.0, double{kNan}, double{kInfinity}, double{-kInfinity}, 0.8, -0.8}) {
    EXPECT_EQ(refusal_of({0.0, increment_rad, 0.0, 1.0}), "angle_increment bad_geometry");
  }
}

TEST(CheckScan, RefusesReachesThatNothingCanBeIn) {
  for (const double min_m : {-0.1, double{kNan}, double{kInfinity}}) {
    EXPECT_EQ(refusal_of({0.0, 0.1, min_m, 1.0}), "range_min bad_geometry");
  }
  for (const double max_m : {0.5, 0.4, -1.0, double{kNan}, double{kInfinity}}) {
    EXPECT_EQ(refusal_of({0.0, 0.1, 0.5, max_m}), "range_max bad_geometry");
  }
}

TEST(IsValid, MeansStrictlyBetweenTheLimits) {
  const ScanGeometry geometry{0.0, 0.1, 0.5, 8.0};
  EXPECT_TRUE(is_valid(0.51F, geometry));
  EXPECT_TRUE(is_valid(7.99F, geometry));
  for (const float miss : {0.0F, -1.0F, 0.5F, 8.0F, 8.191F, kInfinity, -kInfinity, kNan}) {
    EXPECT_FALSE(is_valid(miss, geometry)) << miss;
  }
}

TEST(IsValid, IsNeverTrueOfZero) { EXPECT_FALSE(is_valid(0.0F, {0.0, 0.1, 0.0, 8.0})); }

TEST(ValidBeams, CountsHits) {
  Scan scan = round_room(1.0, at_s(0.0));
  scan.ranges_m = {1.0F, kNan, 2.0F, 0.0F, kInfinity};
  EXPECT_EQ(valid_beams(scan), 2U);
}

TEST(IsComparable, NeedsTwentyBeamsAndOneInTen) {
  EXPECT_TRUE(is_comparable(with_valid_beams(20, 200)));
  EXPECT_FALSE(is_comparable(with_valid_beams(19, 20)));
  EXPECT_FALSE(is_comparable(with_valid_beams(20, 201)));
  EXPECT_TRUE(is_comparable(with_valid_beams(36, 360)));
  EXPECT_FALSE(is_comparable(with_valid_beams(35, 360)));
}

}  // namespace
}  // namespace kidnapwatch::core
