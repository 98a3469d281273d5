// SPDX-License-Identifier: Apache-2.0
// Logistic regression against statsmodels, and where there is no maximum.
#include "core/evaluation/logistic_regression.hpp"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/core/evaluation/golden.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

std::vector<std::size_t> indices(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

/// Calls check(kind, row, examples) for every golden fit, with the examples before it.
template <typename Check>
int for_each_fit(Check check) {
  std::vector<Example> examples;
  bool complete = false;
  int fits = 0;
  for (const auto& row : golden_rows("logistic.csv")) {
    if (row[0] == "example") {
      if (complete) examples.clear();
      complete = false;
      examples.push_back({numbers(row[2]), row[1] == "1.0"});
      continue;
    }
    complete = true;
    check(row[0], row, examples);
    ++fits;
  }
  return fits;
}

void expect_equal(const LogisticModel& model, const std::vector<std::string>& row) {
  const auto coefficients = numbers(row[1]);
  const auto errors = numbers(row[2]);
  const auto selected = row.size() > 4 ? numbers(row[4]) : std::vector<double>{};
  EXPECT_TRUE(model.converged);
  EXPECT_EQ(model.selected, indices(selected));
  EXPECT_NEAR(model.intercept, coefficients[0], 1e-8);
  EXPECT_NEAR(model.intercept_error, errors[0], 1e-8);
  ASSERT_EQ(model.coefficients.size() + 1, coefficients.size());
  for (std::size_t i = 1; i < coefficients.size(); ++i) {
    EXPECT_NEAR(model.coefficients[i - 1], coefficients[i], 1e-8);
    EXPECT_NEAR(model.coefficient_errors[i - 1], errors[i], 1e-8);
  }
  EXPECT_NEAR(model.log_likelihood, numbers(row[3])[0], 1e-9);
}

TEST(LogisticRegression, EqualsStatsmodels) {
  const int fits = for_each_fit([](const auto& kind, const auto& row, const auto& examples) {
    if (kind == "fit") expect_equal(fit(examples, indices(numbers(row[4]))), row);
  });
  EXPECT_EQ(fits, 12);
}

TEST(LogisticRegression, SelectsTheFeaturesThatStatsmodelsDoes) {
  for_each_fit([](const auto& kind, const auto& row, const auto& examples) {
    if (kind == "stepwise") expect_equal(stepwise(examples), row);
  });
}

TEST(LogisticRegression, ShrinksCoefficientsButNotTheIntercept) {
  for_each_fit([](const auto& kind, const auto& row, const auto& examples) {
    if (kind != "ridge") return;
    const auto expected = numbers(row[1]);
    std::vector<std::size_t> all(expected.size() - 1);
    std::iota(all.begin(), all.end(), std::size_t{0});
    const LogisticModel model = fit(examples, all, {.ridge = numbers(row[2])[0]});
    EXPECT_NEAR(model.intercept, expected[0], 1e-8);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(model.coefficients[i], expected[i + 1], 1e-8);
    }
  });
}

TEST(LogisticRegression, SaysWhereThereIsNoMaximumAndARidgeMakesOne) {
  const std::vector<Example> parted{{{0.0}, false}, {{1.0}, false}, {{2.0}, true}, {{3.0}, true}};
  const std::vector<std::size_t> all{0};
  EXPECT_FALSE(fit(parted, all, {.iterations = 20}).converged);
  const LogisticModel model = fit(parted, all, {.ridge = 0.1});
  EXPECT_TRUE(model.converged);
  EXPECT_LT(probability(model, std::vector{1.0}), 0.5);
  EXPECT_GT(probability(model, std::vector{2.0}), 0.5);
}

TEST(LogisticRegression, PredictsAsManyKidnappingsAsThereWere) {
  for_each_fit([](const auto& kind, const auto& row, const auto& examples) {
    if (kind != "fit") return;
    const LogisticModel model = fit(examples, indices(numbers(row[4])));
    double predicted = 0.0;
    double seen = 0.0;
    for (const Example& example : examples) {
      predicted += probability(model, example.features);
      seen += example.kidnapped ? 1.0 : 0.0;
    }
    EXPECT_NEAR(predicted, seen, 1e-6);  // the intercept's score equation
  });
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
