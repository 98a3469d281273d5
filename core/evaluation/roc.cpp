// SPDX-License-Identifier: Apache-2.0
// ROC curves from sorted scores; the area's variance from midranks (Sun and Xu 2014).
#include "core/evaluation/roc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/moments.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

constexpr double kNormal95 = 1.959963984540054;  // 97.5th percentile of the normal distribution

/// Ranks from 1, where equal values share the mean of theirs.
std::vector<double> midranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double shared = 0.5 * static_cast<double>(begin + 1 + end);
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = shared;
    begin = end;
  }
  return ranks;
}

/// How many of the others are below each value: its rank among all less its rank among its own.
std::vector<double> others_below(std::span<const double> own, std::span<const double> all_ranks) {
  std::vector<double> below = midranks(own);
  std::ranges::transform(below, all_ranks, below.begin(),
                         [](double rank, double rank_of_all) { return rank_of_all - rank; });
  return below;
}

void measure_area(std::span<const double> natural, std::span<const double> kidnapped, Roc& roc) {
  std::vector<double> all(kidnapped.begin(), kidnapped.end());
  all.insert(all.end(), natural.begin(), natural.end());
  const std::vector<double> ranks = midranks(all);
  const std::span<const double> all_ranks(ranks);
  const auto m = static_cast<double>(kidnapped.size());
  const auto n = static_cast<double>(natural.size());
  const Moments above =
      moments(others_below(kidnapped, all_ranks.first(kidnapped.size())));  // of n
  const Moments below =
      moments(others_below(natural, all_ranks.subspan(kidnapped.size())));  // of m
  roc.auc = above.mean / n;
  const double sd = std::sqrt(above.variance / (n * n * m) + below.variance / (m * m * n));
  roc.auc_low = std::max(0.0, roc.auc - kNormal95 * sd);
  roc.auc_high = std::min(1.0, roc.auc + kNormal95 * sd);
}

}  // namespace

Roc roc(std::span<const double> natural, std::span<const double> kidnapped) {
  assert(!natural.empty() && !kidnapped.empty());
  std::vector<double> n(natural.begin(), natural.end());
  std::vector<double> k(kidnapped.begin(), kidnapped.end());
  std::ranges::sort(n, std::greater<>());
  std::ranges::sort(k, std::greater<>());
  Roc result;
  result.natural = n.size();
  result.kidnapped = k.size();
  result.points.push_back({std::numeric_limits<double>::infinity(), 0.0, 0.0});
  for (std::size_t i = 0, j = 0; i < n.size() || j < k.size();) {
    const double threshold = i == n.size() || (j < k.size() && k[j] > n[i]) ? k[j] : n[i];
    while (i < n.size() && n[i] == threshold) ++i;
    while (j < k.size() && k[j] == threshold) ++j;
    result.points.push_back({threshold, static_cast<double>(i) / static_cast<double>(n.size()),
                             static_cast<double>(j) / static_cast<double>(k.size())});
  }
  measure_area(natural, kidnapped, result);
  return result;
}

double tpr_at(const Roc& roc, double fpr) {
  double found = 0.0;
  for (const RocPoint& point : roc.points) {
    if (point.fpr <= fpr) found = point.tpr;
  }
  return found;
}

}  // namespace kidnapwatch::core::evaluation
