// SPDX-License-Identifier: Apache-2.0
// Algorithm 3 and its five siblings.
#include "core/dissimilarity.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/dtw.hpp"
#include "core/variance.hpp"
#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array kDimensions{Dimension::ranges, Dimension::points};
constexpr std::array kGates{Gate::paper, Gate::homogeneous, Gate::never, Gate::always};

/// A room with a rough wall, 1 m to 2 m away, seen `scale` times as large.
Scan rough_room(std::uint64_t seed, double scale = 1.0, std::size_t beams = 120) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> wall_m(1.0, 2.0);
  Scan scan = round_room(1.0, at_s(0.0), beams);
  for (float& range_m : scan.ranges_m) {
    range_m = static_cast<float>(scale * wall_m(random));
  }
  return scan;
}

double cost(const Scan& a, const Scan& b, Gate gate, Dimension dimension = Dimension::points) {
  return dissimilarity(a, b, {.dimension = dimension, .gate = gate, .precision = Precision::f64})
      .cost;
}

/// Line 4 of Algorithm 3, spelled out: whether 1 < V < c on every axis of the two scans.
bool paper_gate_opens(const Scan& a, const Scan& b, Gate gate) {
  const Cloud p = cloud(a, InvalidPolicy::drop);
  const Cloud q = cloud(b, InvalidPolicy::drop);
  const double c = critical_value(0.05, p.size() + q.size());
  const double v_x = variance_statistic(VarianceTest::bartlett, p.x, q.x);
  const double v_y = variance_statistic(VarianceTest::bartlett, p.y, q.y);
  const double least = gate == Gate::paper ? 1.0 : -1.0;
  return least < v_x && v_x < c && least < v_y && v_y < c;
}

TEST(Dissimilarity, OfAScanWithItselfIsZero) {
  const Scan scan = rough_room(1);
  for (const auto dimension : kDimensions) {
    for (const auto gate : kGates) {
      EXPECT_EQ(cost(scan, scan, gate, dimension), 0.0);
    }
  }
}

TEST(Dissimilarity, IsSymmetric) {
  for (const auto dimension : kDimensions) {
    for (const auto gate : kGates) {
      const Scan a = rough_room(1);
      const Scan b = rough_room(2, 1.5, 97);
      EXPECT_DOUBLE_EQ(cost(a, b, gate, dimension), cost(b, a, gate, dimension));
    }
  }
}

TEST(Dissimilarity, NeverStandardizedIsTheWarpingCostInMetres) {
  const Scan a = rough_room(1);
  const Scan b = rough_room(2);
  const auto drop = InvalidPolicy::drop;
  EXPECT_EQ(cost(a, b, Gate::never), dtw_cost(cloud(a, drop), cloud(b, drop)));
  EXPECT_EQ(cost(a, b, Gate::never, Dimension::ranges),
            dtw_cost(kept_ranges(a, drop), kept_ranges(b, drop)));
}

TEST(Dissimilarity, InF32IsTheSameToThreePartsInAMillion) {
  for (const auto gate : {Gate::never, Gate::always}) {
    const Scan a = rough_room(1);
    const Scan b = rough_room(2);
    const double exact = cost(a, b, gate);
    EXPECT_NEAR(dissimilarity(a, b, {.gate = gate}).cost, exact, 3e-6 * exact);
  }
}

TEST(Dissimilarity, OfRoundRoomsIsTheDifferenceOfTheirRadii) {
  const Scan small = round_room(2.0, at_s(0.0), 40);
  const Scan large = round_room(3.0, at_s(0.2), 40);
  EXPECT_DOUBLE_EQ(cost(small, large, Gate::never, Dimension::ranges), 40.0);
}

TEST(Dissimilarity, AlwaysStandardizedDoesNotSeeSize) {
  for (const auto dimension : kDimensions) {
    const auto d = dissimilarity(rough_room(1), rough_room(1, 3.0),
                                 {.dimension = dimension, .gate = Gate::always});
    EXPECT_NEAR(d.cost, 0.0, 1e-3);  // sigmas, over 120 beams of float ranges
    EXPECT_TRUE(d.standardized);
  }
}

TEST(Dissimilarity, OnlyCentresWhatDoesNotVary) {
  const auto d = dissimilarity(round_room(2.0, at_s(0.0)), round_room(8.0, at_s(0.2)),
                               {.dimension = Dimension::ranges, .gate = Gate::always});
  EXPECT_EQ(d.cost, 0.0);
  EXPECT_TRUE(d.standardized);
}

TEST(Dissimilarity, DoesNotTakeTheLastDigitOfARangeForSpread) {
  Scan a = round_room(0.001, at_s(0.0));
  a.geometry.range_min_m = 0.0;
  Scan b = a;
  b.ranges_m[7] = std::nextafter(b.ranges_m[7], 1.0F);
  EXPECT_LT(cost(a, b, Gate::always, Dimension::ranges), 1e-8);
}

class GateTest : public testing::TestWithParam<Gate> {};

TEST_P(GateTest, OpensExactlyAsLine4Says) {
  const DissimilarityConfig config{.gate = GetParam(), .precision = Precision::f64};
  int opened = 0;
  constexpr int kPairs = 300;
  for (std::uint64_t i = 0; i < kPairs; ++i) {
    const Scan a = rough_room(2 * i);
    const Scan b = rough_room(2 * i + 1, 0.7 + 0.002 * static_cast<double>(i));
    const bool opens = paper_gate_opens(a, b, GetParam());
    const auto d = dissimilarity(a, b, config);
    EXPECT_EQ(d.standardized, opens) << "pair " << i;
    EXPECT_EQ(d.cost, cost(a, b, opens ? Gate::always : Gate::never)) << "pair " << i;
    opened += opens ? 1 : 0;
  }
  EXPECT_GT(opened, 5);
  EXPECT_LT(opened, kPairs - 5);
}

INSTANTIATE_TEST_SUITE_P(Line4, GateTest, testing::Values(Gate::paper, Gate::homogeneous));

TEST(Dissimilarity, UsesTheVarianceTestAndTheSignificanceThatAreAskedFor) {
  const Scan a = rough_room(1);
  const Scan b = rough_room(2, 1.25);
  const auto standardized = [&](VarianceTest test, double significance) {
    return dissimilarity(a, b,
                         {.dimension = Dimension::ranges,
                          .gate = Gate::homogeneous,
                          .variance_test = test,
                          .significance = significance})
        .standardized;
  };
  const auto p = kept_ranges(a, InvalidPolicy::drop);
  const auto q = kept_ranges(b, InvalidPolicy::drop);
  for (const auto test :
       {VarianceTest::bartlett, VarianceTest::levene, VarianceTest::brown_forsythe}) {
    const double v = variance_statistic(test, p, q);
    for (const double significance : {0.2, 0.05, 0.01, 0.001}) {
      EXPECT_EQ(standardized(test, significance),
                v < critical_value(significance, p.size() + q.size()));
    }
  }
  EXPECT_TRUE(standardized(VarianceTest::bartlett, 1e-6));
  EXPECT_FALSE(standardized(VarianceTest::bartlett, 0.9));
}

TEST(Dissimilarity, IsToldPerBeamToo) {
  const Scan a = rough_room(1, 1.0, 100);
  const Scan b = rough_room(2, 1.0, 60);
  const auto d = dissimilarity(a, b, {});
  EXPECT_GT(d.cost, 0.0);
  EXPECT_DOUBLE_EQ(d.cost_per_beam, d.cost / 160.0);
}

TEST(Dissimilarity, CountsTheBeamsThatItKept) {
  Scan a = rough_room(1, 1.0, 100);
  std::fill(a.ranges_m.begin(), a.ranges_m.begin() + 40, 0.0F);
  const Scan b = rough_room(2, 1.0, 100);
  const auto dropped = dissimilarity(a, b, {.gate = Gate::never});
  EXPECT_DOUBLE_EQ(dropped.cost_per_beam, dropped.cost / 160.0);
  const auto clamped = dissimilarity(a, b, {.gate = Gate::never, .invalid = InvalidPolicy::clamp});
  EXPECT_DOUBLE_EQ(clamped.cost_per_beam, clamped.cost / 200.0);
  EXPECT_GT(clamped.cost, dropped.cost);
}

TEST(DetectorName, IsThePapersNameOfTheVariant) {
  const auto named = [](Dimension dimension, Gate gate) {
    return detector_name({.dimension = dimension, .gate = gate});
  };
  EXPECT_EQ(named(Dimension::points, Gate::paper), "qs2ddtw");
  EXPECT_EQ(named(Dimension::points, Gate::homogeneous), "qs2ddtw");
  EXPECT_EQ(named(Dimension::points, Gate::never), "2ddtw");
  EXPECT_EQ(named(Dimension::points, Gate::always), "s2ddtw");
  EXPECT_EQ(named(Dimension::ranges, Gate::paper), "qs1ddtw");
  EXPECT_EQ(named(Dimension::ranges, Gate::homogeneous), "qs1ddtw");
  EXPECT_EQ(named(Dimension::ranges, Gate::never), "1ddtw");
  EXPECT_EQ(named(Dimension::ranges, Gate::always), "s1ddtw");
}

}  // namespace
}  // namespace kidnapwatch::core
