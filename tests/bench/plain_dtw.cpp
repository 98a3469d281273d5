// SPDX-License-Identifier: Apache-2.0
// The usual ways to write Algorithm 1, compiled for this very processor.
#include "tests/bench/plain_dtw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace kidnapwatch::bench {
namespace {

std::vector<float> floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

float smaller(float a, float b) { return a < b ? a : b; }  // an instruction; std::min is not

/// diagonal[i] of one cell and its three neighbours, for the points p[i] and q[last - i].
void step(std::size_t count, const float* px, const float* py, const float* qx, const float* qy,
          const float* before, const float* before_that, float* diagonal) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float d = std::abs(px[i] - qx[i]) + std::abs(py[i] - qy[i]);
    diagonal[i + 1] = d + smaller(smaller(before[i], before[i + 1]), before_that[i]);
  }
}

}  // namespace

double two_rows(const core::Cloud& p, const core::Cloud& q) {
  constexpr double kNoPath = std::numeric_limits<double>::infinity();
  std::vector<double> above(q.size() + 1, kNoPath);
  std::vector<double> row(q.size() + 1);
  above[0] = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    row[0] = kNoPath;
    for (std::size_t j = 0; j < q.size(); ++j) {
      const double d = std::abs(p.x[i] - q.x[j]) + std::abs(p.y[i] - q.y[j]);
      row[j + 1] = d + std::min({above[j + 1], row[j], above[j]});
    }
    std::swap(above, row);
  }
  return above.back();
}

float wavefront(const core::Cloud& p, const core::Cloud& q) {
  constexpr float kNoPath = std::numeric_limits<float>::infinity();
  const std::size_t n = p.size();
  const std::size_t m = q.size();
  const auto px = floats(p.x);
  const auto py = floats(p.y);
  const auto qx = floats({q.x.rbegin(), q.x.rend()});  // backwards: both ascend along a diagonal
  const auto qy = floats({q.y.rbegin(), q.y.rend()});
  // diagonals[.][i + 1] is the cell of row i; diagonal k has the cells i + j = k.
  std::array<std::vector<float>, 3> diagonals;
  diagonals.fill(std::vector<float>(n + 1, kNoPath));
  auto& [before_that, before, diagonal] = diagonals;
  before_that[0] = 0.0F;  // what the first cell comes from
  for (std::size_t k = 0; k + 1 < n + m; ++k) {
    const std::size_t first = k < m ? 0 : k - m + 1;
    const std::size_t last = std::min(k, n - 1);
    diagonal[0] = kNoPath;  // above the first row; forgets the cell that the first came from
    step(last - first + 1, &px[first], &py[first], &qx[m - 1 - k + first], &qy[m - 1 - k + first],
         &before[first], &before_that[first], &diagonal[first]);
    std::swap(before_that, before);
    std::swap(before, diagonal);
  }
  return before[n];
}

}  // namespace kidnapwatch::bench
