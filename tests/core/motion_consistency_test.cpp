// SPDX-License-Identifier: Apache-2.0
// Features of a pair of scans and what they speak for.
#include "core/motion_consistency.hpp"

#include <gtest/gtest.h>

#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

const Pose kHere{4.0, 2.0, 0.3};

Comparison compared(const Pose& motion, const Pose& told, unsigned seed = 1) {
  Contour before;
  Contour now;
  trace(seen_from(furnished_room(), kHere, at_s(0.0), 360, 0.01, seed), before);
  trace(seen_from(furnished_room(), kHere * motion, at_s(0.1), 360, 0.01, seed + 1), now);
  return compare(before, now, {told, told, true});
}

/// A robot that has driven here for a while.
Habits experienced() {
  Habits normal;
  for (unsigned i = 0; i < 80; ++i) {
    const Pose motion{0.001 * i, 0.0, 0.001 * i};
    normal.learn(compared(motion, motion, 2 * i).features);
  }
  return normal;
}

TEST(Compare, SeesTheMotion) {
  const Pose motion{0.05, 0.0, 0.05};
  const Comparison pair = compared(motion, motion);
  EXPECT_TRUE(pair.judged);
  EXPECT_LT(distance_m(pair.seen, motion), 0.02);
  EXPECT_GT(pair.at_seen.quality(), 0.9F);
}

TEST(Compare, HasNoOpinionWithoutPoints) {
  Contour nothing;
  trace(round_room(0.0, at_s(0.0), 360), nothing);
  EXPECT_FALSE(compare(nothing, nothing, {}).judged);
}

TEST(Compare, IsLenientTowardsWhatWasToldIfTheExpectationIsWrong) {
  Contour before;
  Contour now;
  const Pose motion{0.05, 0.0, 0.0};
  trace(seen_from(furnished_room(), kHere), before);
  trace(seen_from(furnished_room(), kHere * motion), now);
  const Comparison pair = compare(before, now, {motion, {0.1, 0.0, 0.1}, true});
  const auto turn = static_cast<std::size_t>(Feature::turn);
  EXPECT_LT(pair.lenient[turn], pair.features[turn]);
}

TEST(Habits, FindsNothingInANaturalPair) {
  const Pose motion{0.04, 0.0, 0.03};
  EXPECT_LT(experienced().clues(compared(motion, motion).features).sum(), 1.0F);
}

TEST(Habits, TellsAJumpByMisfit) {
  const Pose jump{-3.0, 2.5, 2.0};
  EXPECT_GT(experienced().clues(compared(jump, {}).features).misfit, 3.0F);
}

TEST(Habits, TellsAShortMoveByShiftAndATurnByTurn) {
  const Habits normal = experienced();
  EXPECT_GT(normal.clues(compared({0.3, 0.0, 0.0}, {}).features).shift, 4.0F);
  EXPECT_GT(normal.clues(compared({0.0, 0.0, 0.5}, {}).features).turn, 4.0F);
}

TEST(Habits, AllowsForMoreMotionThanUsual) {
  const Habits normal = experienced();
  const Pose usual{0.04, 0.0, 0.03};
  const Pose fast{0.4, 0.0, 0.4};
  EXPECT_FLOAT_EQ(normal.allowance(compared(usual, usual).features), 0.0F);
  EXPECT_GT(normal.allowance(compared(fast, fast).features), 2.0F);
}

TEST(Confirmed, WantsBothPairsAndTheSilenceOfTheNext) {
  const Clues strong{.misfit = 10.0F, .elsewhere = 8.0F};
  const Clues nothing;
  EXPECT_FLOAT_EQ(confirmed(strong, strong, nothing, nothing).sum(), 18.0F);
  EXPECT_FLOAT_EQ(confirmed(strong, nothing, strong, nothing).sum(), 0.0F);  // a glitch
  EXPECT_FLOAT_EQ(confirmed(strong, strong, strong, nothing).sum(), 0.0F);   // noise
}

TEST(Confirmed, WantsNoSuchShiftJustBefore) {
  const Clues off{.shift = 6.0F};
  EXPECT_FLOAT_EQ(confirmed(off, off, {}, off).sum(), 0.0F);  // odometry that keeps being wrong
}

TEST(Confirmed, HoldsOneKindOfClueAgainstItselfOnly) {
  const Clues jump{.misfit = 10.0F, .unmatched = 8.0F};
  const Clues wobble{.turn = 9.0F};
  EXPECT_FLOAT_EQ(confirmed(jump, jump, wobble, {}).sum(), 18.0F);
}

}  // namespace
}  // namespace kidnapwatch::core
