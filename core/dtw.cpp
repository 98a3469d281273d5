// SPDX-License-Identifier: Apache-2.0
// Dynamic time warping in one row of doubles: plain, exact, and the oracle of any faster version.
#include "core/dtw.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace kidnapwatch::core {
namespace {

/// Algorithm 1, lines 3-5: D(i,j) = d(i,j) + min(D(i-1,j), D(i-1,j-1), D(i,j-1)).
template <typename Distance>
double cheapest_path(std::size_t n, std::size_t m, Distance distance) {
  constexpr double kNoPath = std::numeric_limits<double>::infinity();
  std::vector<double> row(m, kNoPath);
  for (std::size_t i = 0; i < n; ++i) {
    double diagonal = i == 0 ? 0.0 : kNoPath;
    double left = kNoPath;
    for (std::size_t j = 0; j < m; ++j) {
      // `left` last: only one min and one add stand between two cells of a row.
      left = distance(i, j) + std::min(std::min(row[j], diagonal), left);
      diagonal = row[j];
      row[j] = left;
    }
  }
  return row.back();
}

}  // namespace

double dtw_cost(const Cloud& p, const Cloud& q) {
  assert(p.size() > 0 && q.size() > 0);
  return cheapest_path(p.size(), q.size(), [&](std::size_t i, std::size_t j) {
    return std::abs(p.x[i] - q.x[j]) + std::abs(p.y[i] - q.y[j]);
  });
}

double dtw_cost(std::span<const double> p, std::span<const double> q) {
  assert(!p.empty() && !q.empty());
  return cheapest_path(p.size(), q.size(),
                       [&](std::size_t i, std::size_t j) { return std::abs(p[i] - q[j]); });
}

}  // namespace kidnapwatch::core
