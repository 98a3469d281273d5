// SPDX-License-Identifier: Apache-2.0
// The choice of a tuning: the best on other folders, whatever the one left out holds.
#include "core/evaluation/tunings.hpp"

#include <set>

#include <gtest/gtest.h>

#include "core/evaluation/rates.hpp"
#include "core/motion_detector.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

constexpr std::size_t kOdd = 3;  // the candidate that does something else
constexpr double kRate = 1e-3;

/// A run with natural scores 0 .. 4 and one kind of kidnapping and confounder each.
TrialResult run(double kidnapped, double confounded) {
  TrialResult result;
  result.own_threshold = 3.0;
  for (int i = 0; i < 3000; ++i) result.natural.push_back(4.0 * i / 3000.0);
  result.kidnaps["far"] = {{.highest = kidnapped}, {.highest = 9.0}};
  result.confounders["glitch"] = {{.highest = confounded}, {.highest = 0.0}};
  return result;
}

/// All candidates do the same but kOdd.
Rehearsal rehearsal(std::string folder, const TrialResult& usual, const TrialResult& odd) {
  Rehearsal all{std::move(folder), {}};
  all.results.assign(candidates().size(), usual);
  all.results[kOdd] = odd;
  return all;
}

Rehearsal better(std::string folder) {
  return rehearsal(std::move(folder), run(2.0, 0.0), run(8.0, 0.0));
}
Rehearsal worse(std::string folder) {
  return rehearsal(std::move(folder), run(2.0, 0.0), run(8.0, 8.0));
}

TEST(Candidates, DifferAndHoldWhatIsShipped) {
  std::set<std::string_view> names;
  std::size_t shipped = 0;
  for (const Candidate& one : candidates()) {
    names.insert(one.name);
    shipped += one.tuning == MotionTuning{} ? 1 : 0;
    for (const Candidate& other : candidates())
      EXPECT_EQ(one.tuning == other.tuning, one.name == other.name) << one.name;
  }
  EXPECT_EQ(names.size(), candidates().size());
  EXPECT_EQ(shipped, 1U);
}

TEST(Chosen, FindsMostKidnappings) {
  const std::vector runs{better("a"), better("b")};
  const Choice choice = chosen(runs, "elsewhere", kRate);
  EXPECT_EQ(choice.candidate, kOdd);
  EXPECT_DOUBLE_EQ(choice.worth, 1.0);
}

TEST(Chosen, PaysForConfoundersThatAlarm) {
  const std::vector runs{worse("a"), better("b"), better("c")};
  EXPECT_EQ(chosen(runs, "elsewhere", kRate).candidate, 0U);
}

TEST(Chosen, NeverLooksAtTheFolderLeftOut) {
  std::vector runs{better("a"), better("a"), better("left out")};
  const Choice before = chosen(runs, "left out", kRate);
  runs[2] = worse("left out");
  for (TrialResult& result : runs[2].results) result.natural.assign(3000, 20.0);
  const Choice after = chosen(runs, "left out", kRate);
  EXPECT_EQ(after.candidate, before.candidate);
  EXPECT_EQ(after.floor, before.floor);
  EXPECT_EQ(after.worth, before.worth);
  EXPECT_NE(chosen(runs, "a", kRate).candidate, before.candidate);  // who may look sees it
}

TEST(Chosen, HasTheFloorThatFewNaturalPairsExceed) {
  const std::vector runs{better("a")};
  const double floor = chosen(runs, "b", kRate).floor;
  EXPECT_NEAR(floor, 4.0, 0.01);
  EXPECT_EQ(share_above(runs[0].results[0].natural, floor).hits, 3U);
}

TEST(Chosen, RaisesTheFloorWhereThatForgivesMore) {
  std::vector runs{better("a")};
  for (TrialResult& result : runs[0].results) result.confounders["glitch"][0].highest = 5.2;
  const Choice choice = chosen(runs, "b", kRate);
  EXPECT_EQ(choice.floor, 5.5);  // and no higher: the kidnapping of 8 is to be found
  EXPECT_DOUBLE_EQ(choice.worth, 1.0);
}

TEST(Chosen, RulesOutFalseCarries) {
  std::vector runs{better("a")};
  runs[0].results[kOdd].carry_alarms = 1;  // of 3000
  EXPECT_EQ(chosen(runs, "b", kRate).candidate, 0U);
}

TEST(Chosen, IsTheFirstWhereThereIsNothingToChooseBy) {
  Rehearsal cold = better("a");
  for (TrialResult& result : cold.results) result.own_threshold.reset();
  const std::vector runs{cold, Rehearsal{"b", {}}, better("c")};
  const Choice choice = chosen(runs, "c", kRate);
  EXPECT_EQ(choice.candidate, 0U);
  EXPECT_EQ(choice.floor, MotionConfig{}.threshold_min);
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
