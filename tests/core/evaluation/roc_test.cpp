// SPDX-License-Identifier: Apache-2.0
// ROC curves: drawn by hand, against scipy's areas and DeLong's definition.
#include "core/evaluation/roc.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/core/evaluation/golden.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

TEST(Roc, GoesUpForKidnappingsAndRightForFalseAlarms) {
  const Roc curve = roc(std::vector{1.0, 2.0, 4.0, 4.0}, std::vector{5.0, 4.0});
  ASSERT_EQ(curve.points.size(), 5U);
  EXPECT_EQ(curve.points[1], (RocPoint{5.0, 0.0, 0.5}));
  EXPECT_EQ(curve.points[2], (RocPoint{4.0, 0.5, 1.0}));
  EXPECT_EQ(curve.points[4], (RocPoint{1.0, 1.0, 1.0}));
  EXPECT_EQ(curve.natural, 4U);
  EXPECT_EQ(curve.kidnapped, 2U);
}

TEST(Roc, AreaAndIntervalEqualScipysAndDeLongs) {
  const auto rows = golden_rows("roc.csv");
  ASSERT_EQ(rows.size(), 6U);
  for (const auto& row : rows) {
    const double auc = numbers(row[0])[0];
    const double half = 1.959963984540054 * std::sqrt(numbers(row[1])[0]);
    const Roc curve = roc(numbers(row[2]), numbers(row[3]));
    EXPECT_NEAR(curve.auc, auc, 1e-12);
    EXPECT_NEAR(curve.auc_low, std::max(0.0, auc - half), 1e-12);
    EXPECT_NEAR(curve.auc_high, std::min(1.0, auc + half), 1e-12);
  }
}

TEST(Roc, AreaIsThatUnderItsPoints) {
  for (const auto& row : golden_rows("roc.csv")) {
    const Roc curve = roc(numbers(row[2]), numbers(row[3]));
    double area = 0.0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      const RocPoint& a = curve.points[i - 1];
      const RocPoint& b = curve.points[i];
      area += 0.5 * (b.fpr - a.fpr) * (a.tpr + b.tpr);
    }
    EXPECT_NEAR(area, curve.auc, 1e-12);
  }
}

TEST(Roc, TakesInfiniteScores) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Roc curve = roc(std::vector{-infinity, 0.0}, std::vector{infinity, infinity});
  EXPECT_EQ(curve.auc, 1.0);
  EXPECT_EQ(tpr_at(curve, 0.0), 1.0);
}

TEST(Roc, IntervalHoldsTheTruthAboutAsOftenAsItSays) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const double truth = 0.5 * std::erfc(-0.5);  // P(X + 1 > Y), for X and Y standard normal
  int held = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<double> natural(60);
    std::vector<double> kidnapped(40);
    for (double& value : natural) value = normal(random);
    for (double& value : kidnapped) value = normal(random) + 1.0;
    const Roc curve = roc(natural, kidnapped);
    held += static_cast<int>(curve.auc_low <= truth && truth <= curve.auc_high);
  }
  EXPECT_GE(held, 366);  // 380 are expected; fewer than 366 once in 1000 times
}

TEST(TprAt, IsTheBestWithoutMoreFalseAlarms) {
  const Roc curve = roc(std::vector{1.0, 2.0, 3.0, 4.0}, std::vector{2.5, 3.5, 5.0, 6.0});
  EXPECT_EQ(tpr_at(curve, 0.0), 0.5);
  EXPECT_EQ(tpr_at(curve, 0.24), 0.5);
  EXPECT_EQ(tpr_at(curve, 0.25), 0.75);
  EXPECT_EQ(tpr_at(curve, 1.0), 1.0);
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
