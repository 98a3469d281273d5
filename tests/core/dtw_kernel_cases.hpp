// SPDX-License-Identifier: Apache-2.0
// Pairs of scans of every kind, and plain versions of the kernel's arithmetic to hold it to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include <hwy/targets.h>

#include "core/cloud.hpp"
#include "core/dtw.hpp"
#include "core/dtw_kernel.hpp"

namespace kidnapwatch::core {

enum class Kind { normal, kidnap, random, constant, identical, dwelling, tiny, huge };
inline constexpr std::array kKinds{Kind::normal,    Kind::kidnap,   Kind::random, Kind::constant,
                                   Kind::identical, Kind::dwelling, Kind::tiny,   Kind::huge};
inline constexpr std::array<std::string_view, kKinds.size()> kKindNames{
    "normal", "kidnap", "random", "constant", "identical", "dwelling", "tiny", "huge"};

struct Pair {
  Cloud p;
  Cloud q;
};

/// What a lidar with `beams` beams sees at (x, y), turned by `heading`, in a room of
/// `width` x `depth` metres with round pillars; noise of 1 cm.
inline Cloud seen(std::size_t beams, double x, double y, double heading, double width, double depth,
                  std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, 0.01);
  Cloud points;
  for (std::size_t i = 0; i < beams; ++i) {
    const double bearing =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(beams);
    const double dx = std::cos(bearing + heading);
    const double dy = std::sin(bearing + heading);
    const double to_x = ((dx > 0 ? width : 0.0) - x) / dx;
    const double to_y = ((dy > 0 ? depth : 0.0) - y) / dy;
    const bool pillar = std::sin(5.0 * (bearing + heading)) > 0.9;
    const double range_m = std::min(to_x, to_y) * (pillar ? 0.6 : 1.0) + noise(random);
    points.x.push_back(range_m * std::cos(bearing));
    points.y.push_back(range_m * std::sin(bearing));
  }
  return points;
}

inline Cloud scattered(std::size_t size, double scale, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Cloud points;
  for (std::size_t i = 0; i < size; ++i) {
    points.x.push_back(scale * normal(random));
    points.y.push_back(scale * normal(random));
  }
  return points;
}

/// `size` points that stay a while on each of those of `points`.
inline Cloud dwelling_on(const Cloud& points, std::size_t size) {
  Cloud slow;
  for (std::size_t i = 0; i < size; ++i) {
    slow.x.push_back(points.x[i * points.size() / size]);
    slow.y.push_back(points.y[i * points.size() / size]);
  }
  return slow;
}

/// A pair of `n` and `m` points.
inline Pair pair_of(Kind kind, std::size_t n, std::size_t m, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Cloud here = seen(n, 5.0, 3.0, 0.3, 12.0, 8.0, random);
  switch (kind) {
    case Kind::normal:
      return {here, seen(m, 5.05, 3.02, 0.32, 12.0, 8.0, random)};
    case Kind::kidnap:
      return {here, seen(m, 1.0, 6.0, 2.0, 4.0, 9.0, random)};
    case Kind::random:
      return {scattered(n, 1.0, random), scattered(m, 1.0, random)};
    case Kind::constant:
      return {{std::vector(n, 1.1), std::vector(n, -2.3)},
              {std::vector(m, 0.7), std::vector(m, 3.9)}};
    case Kind::identical:
      return {here, n == m ? here : dwelling_on(here, m)};
    case Kind::dwelling:
      return {
          here,
          dwelling_on(seen(std::max<std::size_t>(m / 3, 1), 5.0, 3.0, 0.3, 12.0, 8.0, random), m)};
    case Kind::tiny:
      return {scattered(n, 1e-24, random), scattered(m, 1e-24, random)};
    case Kind::huge:
      return {scattered(n, 1e24, random), scattered(m, 1e24, random)};
  }
  return {};
}

/// Algorithm 1 in one row of `Real`, cell by cell.
template <typename Real, typename Distance>
Real plain_cost(std::size_t n, std::size_t m, Distance distance) {
  constexpr Real kNoPath = std::numeric_limits<Real>::infinity();
  std::vector<Real> row(m, kNoPath);
  Real left = kNoPath;
  for (std::size_t i = 0; i < n; ++i) {
    Real diagonal = i == 0 ? Real(0) : kNoPath;
    left = kNoPath;
    for (std::size_t j = 0; j < m; ++j) {
      left = distance(i, j) + std::min(std::min(row[j], diagonal), left);
      diagonal = row[j];
      row[j] = left;
    }
  }
  return left;
}

/// What the kernel computes in f32 on points: max(|du|, |dv|) of u = x + y, v = x - y.
inline double plain_cost_f32(const Cloud& p, const Cloud& q) {
  const auto turned = [](const Cloud& points, double sign) {
    std::vector<float> axis;
    for (std::size_t i = 0; i < points.size(); ++i) {
      axis.push_back(static_cast<float>(points.x[i] + sign * points.y[i]));
    }
    return axis;
  };
  const auto pu = turned(p, 1.0);
  const auto pv = turned(p, -1.0);
  const auto qu = turned(q, 1.0);
  const auto qv = turned(q, -1.0);
  return plain_cost<float>(p.size(), q.size(), [&](std::size_t i, std::size_t j) {
    return std::max(std::abs(pu[i] - qu[j]), std::abs(pv[i] - qv[j]));
  });
}

inline double plain_cost_f32(std::span<const double> p, std::span<const double> q) {
  const std::vector<float> a(p.begin(), p.end());
  const std::vector<float> b(q.begin(), q.end());
  return plain_cost<float>(p.size(), q.size(),
                           [&](std::size_t i, std::size_t j) { return std::abs(a[i] - b[j]); });
}

#ifdef HWY_COMPILE_ONLY_STATIC  // without Highway's library: there is no choice
inline std::vector<std::int64_t> instruction_sets() { return {HWY_STATIC_TARGET}; }

struct Lowered {
  explicit Lowered(std::int64_t /*instruction_set*/) {}
};
#else
/// The kernel's instruction sets that this processor has, as Highway's bits.
inline std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> sets{HWY_SCALAR};
  for (const std::int64_t set : {HWY_SSE4, HWY_AVX2, HWY_AVX3, HWY_NEON}) {
    if ((hwy::SupportedTargets() & set) != 0) {
      sets.push_back(set);
    }
  }
  return sets;
}

/// Lowers what the kernel may use to one instruction set while it lives.
class Lowered {
 public:
  explicit Lowered(std::int64_t instruction_set) { use(instruction_set); }
  ~Lowered() { use(0); }
  Lowered(const Lowered&) = delete;
  Lowered& operator=(const Lowered&) = delete;

 private:
  static void use(std::int64_t set) {
    hwy::SetSupportedTargetsForTest(set);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};
#endif

/// The kernel next to the plain versions, over many sequences and all instruction sets.
struct Comparison {
  std::vector<std::int64_t> sets = instruction_sets();
  std::size_t costs = 0;
  std::size_t f64_mismatches = 0;       ///< with the oracle, in any bit
  std::size_t f32_mismatches = 0;       ///< with the same arithmetic cell by cell, in any bit
  double largest_relative_error = 0.0;  ///< of f32, from the oracle, for 90 beams and more

  template <typename Sequence>
  void add(const Sequence& p, const Sequence& q, DtwWorkspace& workspace) {
    const double exact = dtw_cost(p, q);
    const double plain_f32 = plain_cost_f32(p, q);
    for (const std::int64_t set : sets) {
      const Lowered lowered(set);
      f64_mismatches += dtw_cost(p, q, Precision::f64, workspace) != exact ? 1 : 0;
      f32_mismatches += dtw_cost(p, q, Precision::f32, workspace) != plain_f32 ? 1 : 0;
      costs += 2;
    }
    if (std::min(p.size(), q.size()) >= 90 && exact > 0.0) {
      largest_relative_error =
          std::max(largest_relative_error, std::abs(plain_f32 - exact) / exact);
    }
  }

  void add_points_and_ranges(const Pair& pair, DtwWorkspace& workspace) {
    add(pair.p, pair.q, workspace);
    add(std::span<const double>(pair.p.x), std::span<const double>(pair.q.x), workspace);
  }

  [[nodiscard]] std::size_t mismatches() const { return f64_mismatches + f32_mismatches; }
};

}  // namespace kidnapwatch::core
