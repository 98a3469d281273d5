// SPDX-License-Identifier: Apache-2.0
// Stored scores at another threshold: incidents kept, lost and raised.
#include "core/evaluation/what_if.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

using enum TunedDetector;

Stamp at(double seconds) { return later_by_s(Stamp{}, seconds); }

Score paper(double at_s, double cost) {
  Score score;
  score.stamp = at(at_s);
  score.reference = at(at_s - 0.2);
  score.dissimilarity.cost = cost;
  score.state = RobotState::normal;
  return score;
}

Score motion(double at_s, double alone, std::optional<double> confirmed) {
  Score score = paper(at_s, 1.0);
  score.motion = MotionScore{.score = alone, .confirmed = confirmed};
  return score;
}

Incident incident(double before_s, double scan_s) {
  Incident incident;
  incident.before_stamp = at(before_s);
  incident.after_stamp = at(before_s + 0.2);
  incident.scan_stamp = at(scan_s);
  return incident;
}

TEST(WhatIf, AlarmsWhereTheScoreStandsOut) {
  WhatIf what_if(qs2ddtw, 60.0, 30.0);
  int i = 0;
  for (const double cost : {5.0, 5.0, 100.0, 5.0, 5.0, 70.0, 65.0, 5.0, 50.0, 5.0}) {
    what_if.add(paper(0.2 * ++i, cost));
  }
  ASSERT_EQ(what_if.incidents().size(), 1U);  // the two in a row are a fast turn
  EXPECT_EQ(what_if.incidents()[0].first, at(0.6));
  EXPECT_EQ(what_if.incidents()[0].score, 100.0);
  EXPECT_EQ(what_if.scores(), 10U);
  EXPECT_NEAR(what_if.observed_s(), 2.0, 1e-6);
}

TEST(WhatIf, AlarmsWhereTheNextScanConfirmsTheMotion) {
  WhatIf what_if(motion_consistency, 5.0, 30.0);
  what_if.add(motion(0.2, 9.0, {}));
  what_if.add(motion(0.4, 1.0, 4.0));  // not confirmed
  what_if.add(motion(0.6, 4.0, 9.0));  // not suspected
  what_if.add(motion(0.8, 7.0, -1.0));
  what_if.add(motion(1.0, 1.0, 8.0));
  EXPECT_EQ(what_if.incidents(), (std::vector<WouldBe>{{at(0.8), at(0.8), 8.0}}));
}

TEST(WhatIf, MergesAlarmsThatAreNear) {
  WhatIf what_if(qs2ddtw, 60.0, 10.0);
  for (const double at_s : {1.0, 9.0, 30.0}) {
    what_if.add(paper(at_s - 0.2, 5.0));
    what_if.add(paper(at_s, 100.0 + at_s));
    what_if.add(paper(at_s + 0.2, 5.0));
  }
  EXPECT_EQ(what_if.incidents(),
            (std::vector<WouldBe>{{at(1.0), at(9.0), 109.0}, {at(30.0), at(30.0), 130.0}}));
}

TEST(WhatIf, DoesNotCountSilenceAsObserved) {
  WhatIf what_if(qs2ddtw, 60.0, 10.0);
  Score late = paper(100.0, 5.0);
  late.reference = at(50.0);
  what_if.add(late);
  EXPECT_EQ(what_if.observed_s(), 0.0);
}

TEST(WhatIf, TellsWhatIsKeptLostAndRaised) {
  const std::vector incidents{incident(1.0, 1.4), incident(100.0, 140.0), incident(300.0, 300.4)};
  const std::vector<WouldBe> would_be{
      {at(1.2), at(1.2), 1.0}, {at(120.0), at(120.0), 2.0}, {at(200.0), at(200.0), 3.0}};
  const Difference found = difference(incidents, would_be, 10.0);
  EXPECT_EQ(found.kept, (std::vector{incidents[0], incidents[1]}));
  EXPECT_EQ(found.lost, std::vector{incidents[2]});
  EXPECT_EQ(found.raised, std::vector{would_be[2]});
}

TEST(WhatIf, KnowsWhatADetectorDecidedOn) {
  Incident one;
  one.detector = "motion_consistency";
  EXPECT_TRUE(decided_on(motion_consistency, one));
  EXPECT_FALSE(decided_on(qs2ddtw, one));
  one.kind = IncidentKind::carry;
  EXPECT_FALSE(decided_on(motion_consistency, one));
  one = {};
  one.detector = "qs1ddtw";
  EXPECT_TRUE(decided_on(qs2ddtw, one));
}

TEST(WhatIf, TakesNaturalScoresOnly) {
  EXPECT_EQ(natural_score(qs2ddtw, paper(0.0, 7.0)), 7.0);
  EXPECT_EQ(natural_score(motion_consistency, paper(0.0, 7.0)), std::nullopt);
  EXPECT_EQ(natural_score(motion_consistency, motion(0.0, 1.0, 3.0)), 3.0);
  Score open = paper(0.0, 7.0);
  open.state = RobotState::kidnapped;
  EXPECT_EQ(natural_score(qs2ddtw, open), std::nullopt);
}

TEST(WhatIf, NamesDetectors) {
  EXPECT_EQ(tuned_detector("qs2ddtw", "detector"), qs2ddtw);
  EXPECT_EQ(name(motion_consistency), "motion_consistency");
  EXPECT_THROW((void)tuned_detector("ndt_qe", "detector"), BadInput);
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
