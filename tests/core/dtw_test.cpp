// SPDX-License-Identifier: Apache-2.0
// Dynamic time warping against the definition: the best of all warping paths.
#include "core/dtw.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kidnapwatch::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Coordinates on a grid of 1/8 m: sums of them are exact in any order.
double on_grid(int steps) { return 0.125 * steps; }

Cloud drawn_cloud(std::size_t most, int reach) {
  const auto n = *rc::gen::inRange<std::size_t>(1, most + 1);
  const auto axis = rc::gen::container<std::vector<double>>(
      n, rc::gen::map(rc::gen::inRange(-reach, reach + 1), on_grid));
  return {*axis, *axis};
}

Cloud seeded_cloud(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.x.push_back(on_grid(static_cast<int>(random() % 64) - 32));
    cloud.y.push_back(on_grid(static_cast<int>(random() % 64) - 32));
  }
  return cloud;
}

double distance(const Cloud& p, std::size_t i, const Cloud& q, std::size_t j) {
  return std::abs(p.x[i] - q.x[j]) + std::abs(p.y[i] - q.y[j]);
}

/// The least cost of all paths from (i, j) to the end, by walking each of them.
double best_of_all_paths(const Cloud& p, const Cloud& q, std::size_t i = 0, std::size_t j = 0) {
  const bool p_ends = i + 1 == p.size();
  const bool q_ends = j + 1 == q.size();
  double rest = p_ends && q_ends ? 0.0 : kInfinity;
  if (!p_ends) {
    rest = std::min(rest, best_of_all_paths(p, q, i + 1, j));
  }
  if (!q_ends) {
    rest = std::min(rest, best_of_all_paths(p, q, i, j + 1));
  }
  if (!p_ends && !q_ends) {
    rest = std::min(rest, best_of_all_paths(p, q, i + 1, j + 1));
  }
  return distance(p, i, q, j) + rest;
}

/// Algorithm 1 with the whole matrix, as a textbook has it: the truth for clouds of a lidar's size.
double textbook_cost(const Cloud& p, const Cloud& q) {
  const std::size_t width = q.size() + 1;
  std::vector<double> d((p.size() + 1) * width, kInfinity);
  d[0] = 0.0;
  for (std::size_t i = 1; i <= p.size(); ++i) {
    for (std::size_t j = 1; j <= q.size(); ++j) {
      const std::size_t up = (i - 1) * width + j;
      d[i * width + j] =
          distance(p, i - 1, q, j - 1) + std::min({d[up], d[up - 1], d[i * width + j - 1]});
    }
  }
  return d.back();
}

/// The cloud with every point in a row of equal ones but the first left out.
Cloud without_dwelling(const Cloud& cloud) {
  Cloud moving;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i == 0 || distance(cloud, i - 1, cloud, i) > 0.0) {
      moving.x.push_back(cloud.x[i]);
      moving.y.push_back(cloud.y[i]);
    }
  }
  return moving;
}

RC_GTEST_PROP(DtwCost, EqualsTheBestOfAllPaths, ()) {
  const Cloud p = drawn_cloud(6, 40);
  const Cloud q = drawn_cloud(6, 40);
  RC_ASSERT(dtw_cost(p, q) == best_of_all_paths(p, q));
}

RC_GTEST_PROP(DtwCost, IsSymmetric, ()) {
  const Cloud p = drawn_cloud(60, 100);
  const Cloud q = drawn_cloud(60, 100);
  RC_ASSERT(dtw_cost(p, q) == dtw_cost(q, p));
}

RC_GTEST_PROP(DtwCost, IsZeroExactlyForCloudsThatDifferInDwellingAlone, ()) {
  const Cloud p = drawn_cloud(4, 1);  // few places, so that clouds often are alike
  const Cloud q = drawn_cloud(4, 1);
  RC_ASSERT((dtw_cost(p, q) == 0.0) == (without_dwelling(p) == without_dwelling(q)));
}

RC_GTEST_PROP(DtwCost, OfACloudWithItselfDwellingIsZero, ()) {
  const Cloud p = drawn_cloud(50, 100);
  Cloud dwelling;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto times = *rc::gen::inRange<std::size_t>(1, 5);
    dwelling.x.insert(dwelling.x.end(), times, p.x[i]);
    dwelling.y.insert(dwelling.y.end(), times, p.y[i]);
  }
  RC_ASSERT(dtw_cost(p, dwelling) == 0.0);
  RC_ASSERT(dtw_cost(dwelling, p) == 0.0);
}

RC_GTEST_PROP(DtwCost, IsTheSameFromTheOtherEnd, ()) {
  const Cloud p = drawn_cloud(40, 100);
  const Cloud q = drawn_cloud(40, 100);
  const auto reversed = [](const Cloud& cloud) {
    return Cloud{{cloud.x.rbegin(), cloud.x.rend()}, {cloud.y.rbegin(), cloud.y.rend()}};
  };
  RC_ASSERT(dtw_cost(p, q) == dtw_cost(reversed(p), reversed(q)));
}

RC_GTEST_PROP(DtwCost, OfRangesIsThatOfACloudOnALine, ()) {
  const Cloud p = drawn_cloud(40, 100);
  const Cloud q = drawn_cloud(40, 100);
  const Cloud flat_p{p.x, std::vector<double>(p.size(), 0.0)};
  const Cloud flat_q{q.x, std::vector<double>(q.size(), 0.0)};
  RC_ASSERT(dtw_cost(p.x, q.x) == dtw_cost(flat_p, flat_q));
}

TEST(DtwCost, EqualsTheTextbookForAllSizesOfLidars) {
  for (const auto& [n, m] : {std::pair{360, 360},
                             {361, 301},
                             {301, 361},
                             {720, 97},
                             {33, 682},
                             {1, 360},
                             {360, 1},
                             {2, 2},
                             {1081, 1080}}) {
    const Cloud p = seeded_cloud(static_cast<std::size_t>(n), 1);
    const Cloud q = seeded_cloud(static_cast<std::size_t>(m), 2);
    EXPECT_EQ(dtw_cost(p, q), textbook_cost(p, q)) << n << " x " << m;
  }
}

TEST(DtwCost, EqualsTheTextbookForEverySmallSize) {
  for (std::size_t n = 1; n < 40; ++n) {
    for (std::size_t m = 1; m < 40; ++m) {
      const Cloud p = seeded_cloud(n, 100 * n + m);
      const Cloud q = seeded_cloud(m, 100 * m + n + 7777);
      EXPECT_EQ(dtw_cost(p, q), textbook_cost(p, q)) << n << " x " << m;
    }
  }
}

TEST(DtwCost, OfOnePointIsTheSumOfItsDistances) {
  EXPECT_EQ(dtw_cost(Cloud{{1.0}, {1.0}}, Cloud{{2.0, 3.0, 1.0}, {1.0, 0.0, -1.0}}), 6.0);
}

TEST(DtwCost, CostsNothingForADelayedStep) {
  EXPECT_EQ(dtw_cost(std::vector{1.0, 1.0, 1.0, 5.0}, std::vector{1.0, 5.0, 5.0, 5.0}), 0.0);
}

TEST(DtwCost, TiesBothEnds) {
  EXPECT_EQ(dtw_cost(std::vector{0.0, 9.0}, std::vector{9.0, 0.0}), 18.0);
}

RC_GTEST_PROP(DtwPath, IsAWarpingPathOfTheLeastCost, ()) {
  const Cloud p = drawn_cloud(30, 40);
  const Cloud q = drawn_cloud(30, 40);
  const auto steps = dtw_path(p, q);
  RC_ASSERT(steps.front().p == 0 && steps.front().q == 0);
  RC_ASSERT(steps.back().p == p.size() - 1 && steps.back().q == q.size() - 1);
  double cost = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    RC_ASSERT(steps[k].cost == distance(p, steps[k].p, q, steps[k].q));
    cost += steps[k].cost;
    if (k == 0) continue;
    const auto on_p = steps[k].p - steps[k - 1].p;
    const auto on_q = steps[k].q - steps[k - 1].q;
    RC_ASSERT(on_p <= 1 && on_q <= 1 && on_p + on_q > 0);
  }
  RC_ASSERT(cost == dtw_cost(p, q));
}

TEST(DtwPath, OfRangesMatchesWhatIsAlike) {
  const Cloud p{{1.0, 1.0, 5.0}, {}};
  const Cloud q{{1.0, 5.0, 5.0}, {}};
  EXPECT_EQ(dtw_path(p, q), (std::vector<WarpingStep>{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 2, 0}}));
}

}  // namespace
}  // namespace kidnapwatch::core
