// SPDX-License-Identifier: Apache-2.0
// Eqs. (2) and (3) on hand-made runs: signs, bounds, what is compared with what.
#include "core/evaluation/performance_index.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core::evaluation {
namespace {

using Scores = std::vector<std::optional<double>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PerformanceIndex, IsTheShareByWhichTheKidnappingStandsOut) {
  const Scores high{std::nullopt, 1.0, 2.0, 8.0, 1.0};
  EXPECT_DOUBLE_EQ(*performance_index(high, 4, Polarity::hptf, Evaluator::prior), 0.75);
  const Scores low{std::nullopt, 8.0, 4.0, 1.0, 8.0};
  EXPECT_DOUBLE_EQ(*performance_index(low, 4, Polarity::lptf, Evaluator::prior), 0.75);
}

TEST(PerformanceIndex, IsNegativeWhereAnotherStepStandsOutMore) {
  const Scores scores{std::nullopt, 1.0, 8.0, 2.0};
  EXPECT_DOUBLE_EQ(*performance_index(scores, 4, Polarity::hptf, Evaluator::prior), -0.75);
  EXPECT_DOUBLE_EQ(*performance_index(scores, 4, Polarity::lptf, Evaluator::prior), -0.5);
}

TEST(PerformanceIndex, IsZeroForATieAndForAllZeros) {
  const Scores tie{std::nullopt, 3.0, 3.0};
  EXPECT_EQ(*performance_index(tie, 3, Polarity::hptf, Evaluator::prior), 0.0);
  const Scores zeros{std::nullopt, 0.0, 0.0};
  EXPECT_EQ(*performance_index(zeros, 3, Polarity::lptf, Evaluator::prior), 0.0);
}

TEST(PerformanceIndex, LooksBehindTheKidnappingOnlyIfToldTo) {
  const Scores scores{std::nullopt, 1.0, 4.0, 8.0};
  EXPECT_DOUBLE_EQ(*performance_index(scores, 3, Polarity::hptf, Evaluator::prior), 0.75);
  EXPECT_DOUBLE_EQ(*performance_index(scores, 3, Polarity::hptf, Evaluator::all), -0.5);
}

TEST(PerformanceIndex, NeverComparesWithTheFirstStep) {
  const Scores scores{100.0, 1.0, 4.0};
  EXPECT_DOUBLE_EQ(*performance_index(scores, 3, Polarity::hptf, Evaluator::all), 0.75);
}

TEST(PerformanceIndex, SaysNothingWithoutAStepToCompareWith) {
  const Scores scores{std::nullopt, 1.0, 4.0};
  EXPECT_FALSE(performance_index(scores, 2, Polarity::hptf, Evaluator::prior));
  EXPECT_TRUE(performance_index(scores, 2, Polarity::hptf, Evaluator::all));
}

TEST(PerformanceIndex, CountsANonFiniteScoreAsNotDetected) {
  for (const double odd : {kInfinity, -kInfinity, std::nan("")}) {
    const Scores kidnapped{std::nullopt, 1.0, odd};
    const Scores natural{std::nullopt, odd, 1.0};
    for (const auto polarity : {Polarity::hptf, Polarity::lptf}) {
      EXPECT_EQ(*performance_index(kidnapped, 3, polarity, Evaluator::prior), -1.0);
      EXPECT_EQ(*performance_index(natural, 3, polarity, Evaluator::prior), -1.0);
    }
  }
  const Scores silent{std::nullopt, 1.0, std::nullopt};
  EXPECT_EQ(*performance_index(silent, 3, Polarity::hptf, Evaluator::prior), -1.0);
}

TEST(PerformanceIndex, LeavesOutStepsWithoutAScore) {
  const Scores scores{std::nullopt, std::nullopt, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(*performance_index(scores, 4, Polarity::hptf, Evaluator::prior), 0.5);
}

TEST(PerformanceIndex, KeepsItsSignUnderMonotoneChangesAndItsBounds) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(0.0, 5.0);
  for (int i = 0; i < 500; ++i) {
    Scores scores(6);
    Scores squared(6);
    for (std::size_t t = 1; t < scores.size(); ++t) {
      scores[t] = value(random);
      squared[t] = *scores[t] * *scores[t];
    }
    for (const auto polarity : {Polarity::hptf, Polarity::lptf}) {
      for (const auto evaluator : {Evaluator::prior, Evaluator::all}) {
        const double eta = *performance_index(scores, 4, polarity, evaluator);
        const double eta_of_squares = *performance_index(squared, 4, polarity, evaluator);
        EXPECT_EQ(eta > 0.0, eta_of_squares > 0.0);
        EXPECT_LE(std::abs(eta), 1.0);
      }
    }
  }
}

TEST(Performance, IsMeanAndShareOfTheUndetected) {
  const std::vector etas{0.5, -0.5, 0.0, 1.0};
  EXPECT_EQ(performance(etas), (Performance{0.25, 0.5, 4}));
  EXPECT_EQ(performance({}), Performance{});
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
