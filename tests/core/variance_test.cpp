// SPDX-License-Identifier: Apache-2.0
// The tests of equal variances against scipy (tests/golden), and where the variances vanish.
#include "core/variance.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

constexpr VarianceTest kTests[] = {VarianceTest::bartlett, VarianceTest::levene,
                                   VarianceTest::brown_forsythe};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> numbers(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

/// The rows of tests/golden/variance.csv that begin with `kind`: a list of numbers per column.
std::vector<std::vector<std::vector<double>>> golden(const std::string& kind) {
  std::ifstream file(KW_GOLDEN_DIR "/variance.csv");
  std::vector<std::vector<std::vector<double>>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream columns(line);
    std::string column;
    if (std::getline(columns, column, ','); column != kind) {
      continue;
    }
    auto& row = rows.emplace_back();
    while (std::getline(columns, column, ',')) {
      row.push_back(numbers(column));
    }
  }
  return rows;
}

TEST(VarianceStatistic, EqualsScipys) {
  const auto rows = golden("statistics");
  ASSERT_EQ(rows.size(), 10U);
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 5U);
    for (std::size_t test = 0; test < std::size(kTests); ++test) {
      const double expected = row[test].at(0);
      const double v = variance_statistic(kTests[test], row[3], row[4]);
      EXPECT_NEAR(v, expected, 1e-9 * (1.0 + expected)) << "test " << test;
    }
  }
}

TEST(CriticalValue, EqualsScipys) {
  const auto rows = golden("critical_value");
  ASSERT_EQ(rows.size(), 35U);
  for (const auto& row : rows) {
    const double expected = row.at(0).at(0);
    const auto samples = static_cast<std::size_t>(row.at(2).at(0));
    EXPECT_NEAR(critical_value(row.at(1).at(0), samples), expected, 1e-9 * expected);
  }
}

TEST(CriticalValue, IsThePapersForTwoScansOf360Beams) {
  EXPECT_NEAR(critical_value(0.05, 720), 3.854, 5e-4);
}

TEST(VarianceStatistic, DoesNotCareWhichSampleIsFirst) {
  const std::vector a{1.0, 2.5, 2.0, 7.0};
  const std::vector b{0.5, 9.0, -3.0, 4.0, 4.5, 6.0};
  for (const auto test : kTests) {
    EXPECT_DOUBLE_EQ(variance_statistic(test, a, b), variance_statistic(test, b, a));
  }
}

TEST(VarianceStatistic, DoesNotCareAboutPlaceAndUnit) {
  const std::vector a{1.0, 2.5, 2.0, 7.0};
  const std::vector b{0.5, 9.0, -3.0, 4.0, 4.5, 6.0};
  const auto in_centimetres_from_afar = [](std::vector<double> sample) {
    for (double& value : sample) {
      value = 100.0 * value + 1234.0;
    }
    return sample;
  };
  for (const auto test : kTests) {
    EXPECT_NEAR(variance_statistic(test, in_centimetres_from_afar(a), in_centimetres_from_afar(b)),
                variance_statistic(test, a, b), 1e-9);
  }
}

TEST(VarianceStatistic, OfASampleAndItselfMovedIsZeroAndNeverLess) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> range_m(0.12, 3.5);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> a(30);
    std::ranges::generate(a, [&] { return range_m(random); });
    std::vector<double> moved(a.size());
    std::ranges::transform(a, moved.begin(), [](double value) { return value + 0.1; });
    for (const auto test : kTests) {
      EXPECT_GE(variance_statistic(test, a, moved), 0.0);
      EXPECT_NEAR(variance_statistic(test, a, moved), 0.0, 1e-9);
    }
  }
}

TEST(VarianceStatistic, IsZeroIfNeitherSampleVaries) {
  for (const auto test : kTests) {
    EXPECT_EQ(variance_statistic(test, std::vector{2.0, 2.0}, std::vector{5.0, 5.0, 5.0}), 0.0);
  }
}

TEST(VarianceStatistic, IsInfiniteIfExactlyOneSampleVaries) {
  const std::vector constant{2.0, 2.0, 2.0};
  const std::vector varied{1.0, 2.0, 4.0};
  for (const auto test : kTests) {
    EXPECT_EQ(variance_statistic(test, constant, varied), kInfinity);
    EXPECT_EQ(variance_statistic(test, varied, constant), kInfinity);
  }
}

TEST(VarianceStatistic, DoesNotTakeRoundingForVariance) {
  const std::vector<double> a(7, 0.1);  // whose computed mean is not 0.1
  const std::vector<double> b(11, 0.3);
  for (const auto test : kTests) {
    EXPECT_EQ(variance_statistic(test, a, b), 0.0);
    EXPECT_EQ(variance_statistic(test, a, std::vector{1.0, 2.0, 4.0}), kInfinity);
  }
}

TEST(VarianceStatistic, IsTheLimitWhereDeviationsAreAllAlike) {
  const std::vector near{0.0, 2.0};
  const std::vector far{0.0, 4.0};
  for (const auto test : {VarianceTest::levene, VarianceTest::brown_forsythe}) {
    EXPECT_EQ(variance_statistic(test, near, far), kInfinity);
    EXPECT_EQ(variance_statistic(test, near, std::vector{5.0, 7.0}), 0.0);
  }
}

}  // namespace
}  // namespace kidnapwatch::core
