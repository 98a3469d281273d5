// SPDX-License-Identifier: Apache-2.0
// Leave one run out: nothing of a run tells on itself.
#include "core/evaluation/held_out.hpp"

#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core::evaluation {
namespace {

/// Runs in which feature 0 tells of kidnappings, feature 1 tells nothing, feature 2 is constant.
std::vector<std::vector<Example>> runs(std::size_t count) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<std::vector<Example>> result(count);
  for (auto& run : result) {
    for (int i = 0; i < 80; ++i) {
      const bool kidnapped = i % 4 == 0;
      run.push_back({{normal(random) + (kidnapped ? 2.0 : 0.0), normal(random), 7.0}, kidnapped});
    }
  }
  return result;
}

TEST(HeldOut, SelectsWhatTellsAndGivesKidnappingsTheHigherProbability) {
  const auto all = runs(4);
  const HeldOut result = held_out(all);
  EXPECT_EQ(result.times_selected[0], 4U);
  EXPECT_EQ(result.times_selected[2], 0U);
  ASSERT_EQ(result.probabilities.size(), 4U);
  double kidnapped = 0.0;
  double natural = 0.0;
  for (std::size_t run = 0; run < all.size(); ++run) {
    ASSERT_EQ(result.probabilities[run].size(), all[run].size());
    for (std::size_t i = 0; i < all[run].size(); ++i) {
      (all[run][i].kidnapped ? kidnapped : natural) += result.probabilities[run][i];
    }
  }
  EXPECT_GT(kidnapped / 80.0, 2.0 * natural / 240.0);
}

TEST(HeldOut, DoesNotLearnFromTheRunThatItJudges) {
  auto all = runs(3);
  const HeldOut before = held_out(all);
  for (Example& example : all[1]) example.kidnapped = !example.kidnapped;
  const HeldOut after = held_out(all);
  EXPECT_EQ(before.probabilities[1], after.probabilities[1]);
  EXPECT_NE(before.probabilities[0], after.probabilities[0]);
}

TEST(HeldOut, DoesNotCareAboutUnits) {
  auto all = runs(3);
  const HeldOut metres = held_out(all);
  for (auto& run : all) {
    for (Example& example : run) example.features[0] = 1000.0 * example.features[0] + 50.0;
  }
  const HeldOut millimetres = held_out(all);
  for (std::size_t i = 0; i < metres.probabilities[0].size(); ++i) {
    EXPECT_NEAR(metres.probabilities[0][i], millimetres.probabilities[0][i], 1e-9);
  }
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
