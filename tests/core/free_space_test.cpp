// SPDX-License-Identifier: Apache-2.0
// Free-space contradictions between two scans.
#include "core/free_space.hpp"

#include <gtest/gtest.h>

#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

Contour traced(const Scan& scan) {
  Contour contour;
  trace(scan, contour);
  return contour;
}

Agreement between(const Scan& before, const Scan& now, const Pose& motion = {}) {
  return agreement(contradictions(traced(before), traced(now), motion));
}

TEST(FreeSpace, AScanAgreesWithItself) {
  const Scan scan = seen_from(furnished_room(), {4.0, 2.0, 0.3});
  const Agreement result = between(scan, scan);
  EXPECT_EQ(result.sectors, 2 * kSectors);
  EXPECT_FLOAT_EQ(result.consistent, 1.0F);
  EXPECT_FLOAT_EQ(result.violating, 0.0F);
}

TEST(FreeSpace, AgreesUnderTheTrueMotionAndNotUnderAnother) {
  const Walls walls = furnished_room();
  const Pose from{4.0, 2.0, 0.3};
  const Pose motion{0.3, 0.1, 0.2};
  const Scan before = seen_from(walls, from);
  const Scan now = seen_from(walls, from * motion);
  EXPECT_GT(between(before, now, motion).quality(), 0.85F);
  EXPECT_LT(between(before, now, {}).quality(), 0.3F);
}

TEST(FreeSpace, WhatIsNearerViolatesAndWhatIsFartherIsHidden) {
  const Agreement result =
      between(round_room(4.0, at_s(0.0), 120), round_room(2.0, at_s(0.0), 120));
  EXPECT_FLOAT_EQ(result.violating, 0.5F);  // the near points; the far ones are hidden
  EXPECT_FLOAT_EQ(result.consistent, 0.0F);
}

TEST(FreeSpace, APointWhereTheOtherSawNothingViolatesOnlyWithinReach) {
  const Scan nothing = round_room(0.0, at_s(0.0), 120);
  EXPECT_FLOAT_EQ(between(nothing, round_room(7.9, at_s(0.0), 120)).violating, 1.0F);
  EXPECT_FLOAT_EQ(between(nothing, round_room(8.1, at_s(0.0), 120)).violating, 0.0F);
}

/// The scan of a lidar whose own robot stands in the way of some beams.
Scan blinkered(Scan scan) {
  for (std::size_t i = 40; i < 60; ++i) scan.ranges_m[i] = 0.0F;
  return scan;
}

TEST(FreeSpace, ABeamThatIsBlindInBothScansContradictsNothing) {
  const Walls walls = furnished_room();
  const Pose from{4.0, 2.0, 0.3};
  const Pose motion{0.06, 0.0, 0.2};  // what is within the tolerance of a point, but turns
  const Scan before = blinkered(seen_from(walls, from));
  const Scan now = blinkered(seen_from(walls, from * motion));
  EXPECT_FLOAT_EQ(between(before, now, motion).violating, 0.0F);
  EXPECT_GT(between(before, seen_from(walls, from * motion), motion).violating, 0.0F);
}

/// The scan with something in front of beams 30 to 30 + `beams`.
Scan hidden(Scan scan, std::size_t beams) {
  for (std::size_t i = 30; i < 30 + beams; ++i) scan.ranges_m[i] = 1.0F;
  return scan;
}

TEST(FreeSpace, SomebodyInFrontDoesNotCount) {
  const Scan before = round_room(4.0, at_s(0.0), 120);
  const Agreement result = between(before, hidden(before, 10));  // half a metre wide
  EXPECT_FLOAT_EQ(result.violating, 0.0F);
  EXPECT_FLOAT_EQ(result.consistent, 1.0F);
}

TEST(FreeSpace, SomethingWideInFrontCountsInItsSectorsAlone) {
  const Scan before = round_room(4.0, at_s(0.0), 120);
  const Agreement result = between(before, hidden(before, 20));
  EXPECT_GT(result.violating, 0.06F);
  EXPECT_FLOAT_EQ(result.violating_elsewhere, 0.0F);
  EXPECT_FLOAT_EQ(result.consistent_elsewhere, 1.0F);
}

TEST(FreeSpace, HasNoOpinionOnEmptyScans) {
  const Scan nothing = round_room(0.0, at_s(0.0), 120);
  EXPECT_EQ(between(nothing, nothing).sectors, 0U);
}

TEST(FreeSpace, TellsWhichBeamsSeeWhatCannotBeThere) {
  const Scan far = round_room(4.0, at_s(0.0), 120);
  Scan near = far;
  for (std::size_t i = 20; i < 60; ++i) near.ranges_m[i] = 2.0F;  // too wide for somebody
  const auto beams = violating_beams(traced(far), traced(near), {});
  ASSERT_EQ(beams.size(), 40U);
  EXPECT_EQ(beams.front(), 20U);
  EXPECT_EQ(beams.back(), 59U);
  EXPECT_TRUE(violating_beams(traced(near), traced(far), {}).empty());  // those are only hidden
}

}  // namespace
}  // namespace kidnapwatch::core
