// SPDX-License-Identifier: Apache-2.0
// Algorithm 2: the quick way for pairwise detectors equals showing them every spliced run.
#include "core/study/algorithm2.hpp"

#include <gtest/gtest.h>

#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {
namespace {

TrialConfig short_trial() {
  TrialConfig config;
  config.steps = 8;
  return config;
}

Detectors all_pairwise() {
  Detectors detectors = ndt_systems();
  for (auto& variant : dtw_systems()) detectors.push_back(std::move(variant));
  return detectors;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5);
}

TEST(Algorithm2, IsTheSameForPairwiseDetectorsTheQuickWay) {
  const Trial trial = drive(sim::turns_world(), short_trial(), 1);
  const auto quick = pairwise_records(trial, all_pairwise);
  const auto slow = records(trial, all_pairwise);
  ASSERT_EQ(quick.size(), slow.size());
  for (std::size_t d = 0; d < quick.size(); ++d) {
    EXPECT_EQ(quick[d].id, slow[d].id);
    EXPECT_EQ(quick[d].natural, slow[d].natural);
    expect_near(quick[d].eta_prior, slow[d].eta_prior);
    expect_near(quick[d].eta_all, slow[d].eta_all);
    expect_near(quick[d].kidnapped, slow[d].kidnapped);
    EXPECT_EQ(quick[d].eta_prior.size(), 6U);  // t_k = 3..8
    EXPECT_EQ(quick[d].natural.size(), 7U);
  }
}

TEST(Algorithm2, CountsAScoreThatIsMissingAsNotDetected) {
  TrialRecord record;
  enter({std::nullopt, 1.0, 5.0, std::nullopt}, 3, record);
  enter({std::nullopt, 1.0, 5.0, std::nullopt}, 4, record);
  EXPECT_EQ(record.eta_prior, (std::vector{0.8, -1.0}));
  EXPECT_EQ(record.kidnapped, (std::vector{5.0}));
}

}  // namespace
}  // namespace kidnapwatch::core::study
