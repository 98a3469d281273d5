// SPDX-License-Identifier: Apache-2.0
// Stamps that repeat, go back or stop, and scans that cannot be compared.
#include <gtest/gtest.h>

#include "tests/core/session_fixture.hpp"

namespace kidnapwatch::core {
namespace {

using SessionOrder = SessionTest;

TEST_F(SessionOrder, CountsTheSameStampAgainAsRepeated) {
  observe(2.0, 0.0);
  const Observation again = observe(8.0, 0.0);
  EXPECT_EQ(again.outcome, Outcome::repeated);
  EXPECT_FALSE(again.verdict);
  EXPECT_NEAR(judged(2.0, 0.2).score.dissimilarity.cost, 0.0, 1e-9);
}

TEST_F(SessionOrder, RefusesOlderScans) {
  observe(2.0, 1.0);
  const Observation older = observe(8.0, 0.5);
  EXPECT_EQ(older.outcome, Outcome::out_of_order);
  EXPECT_FALSE(older.verdict);
  EXPECT_EQ(judged(2.0, 1.2).score.reference, at_s(1.0));
}

TEST_F(SessionOrder, ComparesWithTheLastGoodScan) {
  observe(2.0, 0.0);
  EXPECT_EQ(feed(session_, empty_space(at_s(0.2)), at_s(0.2)).outcome, Outcome::not_comparable);
  const Score score = judged(2.05, 0.4).score;
  EXPECT_EQ(score.reference, at_s(0.0));
  EXPECT_NEAR(score.dissimilarity.cost, 2.0, 1e-5);
}

TEST_F(SessionOrder, DoesNotStartFromAScanThatCannotBeCompared) {
  EXPECT_EQ(feed(session_, empty_space(at_s(0.0)), at_s(0.0)).outcome, Outcome::not_comparable);
  EXPECT_EQ(observe(2.0, 0.2).outcome, Outcome::first);
}

TEST_F(SessionOrder, BelievesAClockThatWasSetBack) {
  observe(2.0, 1000.0);
  EXPECT_EQ(observe(8.0, 1.0).outcome, Outcome::out_of_order);
  EXPECT_EQ(observe(8.0, 1.2).outcome, Outcome::out_of_order);
  EXPECT_EQ(observe(8.0, 1.4).outcome, Outcome::first);  // the third, as configured
  EXPECT_EQ(judged(8.0, 1.6).score.reference, at_s(1.4));
  EXPECT_EQ(session_.state(at_s(1.6)), RobotState::normal);
}

TEST_F(SessionOrder, ComparesWithNothingOnceItForgot) {
  observe(2.0, 1000.0);
  session_.forget_scans();
  EXPECT_EQ(observe(8.0, 1.0).outcome, Outcome::first);
  EXPECT_EQ(judged(8.0, 1.2).score.state, RobotState::normal);
}

TEST_F(SessionOrder, DoesNotBelieveOldScansThatDoNotGoOn) {
  observe(2.0, 1000.0);
  for (int replay = 0; replay < 5; ++replay) {
    EXPECT_EQ(observe(8.0, 1.0).outcome, Outcome::out_of_order);
    EXPECT_EQ(observe(8.0, 1.2).outcome, Outcome::out_of_order);
  }
  EXPECT_EQ(judged(2.0, 1000.2).score.state, RobotState::normal);
}

TEST_F(SessionOrder, CountsOldScansInARowOnly) {
  observe(2.0, 1000.0);
  for (int i = 1; i < 10; ++i) {
    EXPECT_EQ(observe(8.0, 1.0 + 0.2 * i).outcome, Outcome::out_of_order);
    EXPECT_EQ(observe(2.0, 1000.0 + i).outcome, Outcome::scored);
  }
}

TEST_F(SessionOrder, DropsASuspicionWithTheClockButKeepsTheIncident) {
  kidnap();
  judged(5.0, 1000.0);
  for (const double t_s : {1.0, 1.2, 1.4}) {
    observe(5.0, t_s);
  }
  const Verdict verdict = judged(5.0, 1.6);
  EXPECT_FALSE(verdict.change);
  EXPECT_EQ(verdict.score.state, RobotState::kidnapped);
}

TEST_F(SessionOrder, DoesNotMeasureAJumpByWhatWasBeforeTheClockWasSetBack) {
  observe(2.0, 1000.0);
  judged(8.0, 1000.2);
  for (const double t_s : {1.0, 1.2, 1.4}) {
    observe(5.0, t_s);
  }
  judged(3.0, 1.6);
  EXPECT_EQ(judged(3.0, 1.8).change, EpisodeChange::opened);
}

TEST_F(SessionOrder, ResolvesByTheNewClock) {
  kidnap();
  judged(8.0, 1000.0);
  for (const double t_s : {1.0, 1.2, 1.4}) {
    observe(8.0, t_s);
  }
  EXPECT_FALSE(judged(8.0, 2.0).change);
  EXPECT_EQ(judged(8.0, 32.0).change, EpisodeChange::resolved);
}

TEST_F(SessionOrder, IsStaleAfterItsTimeWithoutAScan) {
  EXPECT_EQ(session_.state(at_s(1e6)), RobotState::normal);  // no scan yet to be old
  observe(2.0, 0.0);
  EXPECT_EQ(session_.state(at_s(5.0)), RobotState::normal);
  EXPECT_EQ(session_.state(at_s(5.001)), RobotState::stale);
  observe(2.0, 6.0);
  EXPECT_EQ(session_.state(at_s(6.0)), RobotState::normal);
}

TEST_F(SessionOrder, IsNotStaleWhileScansArriveThatItCannotUse) {
  observe(2.0, 0.0);
  feed(session_, round_room(2.0, at_s(0.0)), at_s(7.0));
  EXPECT_EQ(session_.state(at_s(8.0)), RobotState::normal);
}

}  // namespace
}  // namespace kidnapwatch::core
