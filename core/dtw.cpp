// SPDX-License-Identifier: Apache-2.0
// Dynamic time warping in one row of doubles: plain, exact, and the oracle of any faster version.
#include "core/dtw.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
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

/// Where a cell's cheapest path comes from.
enum class From : std::uint8_t { diagonal, above, left };

From cheapest(double diagonal, double above, double left) {
  if (diagonal <= above && diagonal <= left) return From::diagonal;
  return above <= left ? From::above : From::left;
}

/// The same as cheapest_path(), remembering each cell's choice, row by row.
template <typename Distance>
std::vector<From> choices(std::size_t n, std::size_t m, Distance distance) {
  constexpr double kNoPath = std::numeric_limits<double>::infinity();
  std::vector<From> from(n * m);
  std::vector<double> row(m, kNoPath);
  for (std::size_t i = 0; i < n; ++i) {
    double diagonal = i == 0 ? 0.0 : kNoPath;
    double left = kNoPath;
    for (std::size_t j = 0; j < m; ++j) {
      from[i * m + j] = cheapest(diagonal, row[j], left);
      left = distance(i, j) + std::min({row[j], diagonal, left});
      diagonal = row[j];
      row[j] = left;
    }
  }
  return from;
}

template <typename Distance>
std::vector<WarpingStep> path(std::size_t n, std::size_t m, Distance distance) {
  const auto from = choices(n, m, distance);
  std::vector<WarpingStep> steps;
  std::size_t i = n - 1;
  std::size_t j = m - 1;
  steps.push_back({i, j, distance(i, j)});
  while (i > 0 || j > 0) {
    const From step = from[i * m + j];
    if (step != From::left) --i;
    if (step != From::above) --j;
    steps.push_back({i, j, distance(i, j)});
  }
  std::ranges::reverse(steps);
  return steps;
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

std::vector<WarpingStep> dtw_path(const Cloud& p, const Cloud& q) {
  assert(p.size() > 0 && q.size() > 0);
  if (p.y.empty()) {
    return path(p.size(), q.size(),
                [&](std::size_t i, std::size_t j) { return std::abs(p.x[i] - q.x[j]); });
  }
  return path(p.size(), q.size(), [&](std::size_t i, std::size_t j) {
    return std::abs(p.x[i] - q.x[j]) + std::abs(p.y[i] - q.y[j]);
  });
}

}  // namespace kidnapwatch::core
