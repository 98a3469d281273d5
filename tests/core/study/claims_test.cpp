// SPDX-License-Identifier: Apache-2.0
// Verdicts follow from the numbers alone.
#include "core/study/claims.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {
namespace {

using baselines::Relocalization;

Summary with(const std::string& id, double mean, double undetected) {
  Summary summary;
  summary.id = id;
  summary.performance = {mean, undetected, 100};
  return summary;
}

/// A condition at the paper's reach and noise with every DTW variant at `mean`.
Condition flat(const std::string& map, double mean) {
  Condition condition{map, 3.5, 0.1, {}, {}};
  for (const auto& config : readings()) {
    condition.prior[id_of(config)] = with(id_of(config), mean, 0.2);
    condition.all[id_of(config)] = with(id_of(config), mean, 0.2);
  }
  return condition;
}

const Claim* find(const std::vector<Claim>& all, std::string_view part) {
  const auto found = std::ranges::find_if(
      all, [&](const Claim& claim) { return claim.text.find(part) != std::string::npos; });
  return found == all.end() ? nullptr : &*found;
}

TEST(Claims, HoldIfAllCasesDoInPartIfHalfDoElseNot) {
  std::vector<Condition> conditions{flat("turns", 0.5), flat("tee", 0.5)};
  const Reading reading;
  const auto standardize = [&](std::size_t condition, Dimension dimension) {
    conditions[condition].prior[reading.id(dimension, Gate::always)].performance.mean = 0.1;
  };
  const auto verdict = [&] { return find(claims(conditions, reading), "Standardizing")->verdict; };
  EXPECT_EQ(verdict(), Verdict::fails);
  standardize(0, Dimension::ranges);
  EXPECT_EQ(verdict(), Verdict::fails);
  standardize(0, Dimension::points);
  EXPECT_EQ(verdict(), Verdict::partly);
  standardize(1, Dimension::ranges);
  standardize(1, Dimension::points);
  EXPECT_EQ(verdict(), Verdict::holds);
}

TEST(Claims, AreLeftOutWhereNothingWasRun) {
  EXPECT_TRUE(claims({}, {}).empty());
  const std::vector<Condition> conditions{flat("turns", 0.5)};
  const auto all = claims(conditions, {});
  EXPECT_EQ(find(all, "Maximum current weight"), nullptr);
  EXPECT_EQ(find(all, "metric-based"), nullptr);
  EXPECT_EQ(find(all, "ring"), nullptr);  // another map
}

TEST(Claims, JudgeTheWeightByBothRelocalizations) {
  std::vector<Condition> conditions{flat("turns", 0.5)};
  for (const auto how : {Relocalization::none, Relocalization::global, Relocalization::perfect}) {
    conditions[0].all[mcw_id(how)] = with(mcw_id(how), 0.0, 0.9);
  }
  for (const auto polarity : {Polarity::hptf, Polarity::lptf}) {
    const std::string id = me_id(polarity, Relocalization::perfect);
    conditions[0].all[id] = with(id, 0.0, 0.9);
  }
  EXPECT_EQ(find(claims(conditions, {}), "collapses")->verdict, Verdict::holds);
  EXPECT_EQ(find(claims(conditions, {}), "recovers")->verdict, Verdict::fails);
  conditions[0].all[mcw_id(Relocalization::perfect)].performance.undetected = 0.1;
  EXPECT_EQ(find(claims(conditions, {}), "recovers")->verdict, Verdict::holds);
}

}  // namespace
}  // namespace kidnapwatch::core::study
