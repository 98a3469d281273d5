// SPDX-License-Identifier: Apache-2.0
// The warping kernel against the plain version: the same bits, on every instruction set.
#include "core/dtw_kernel.hpp"

#include <cstdlib>
#include <limits>
#include <new>

#include <gtest/gtest.h>

#include "tests/core/dtw_kernel_cases.hpp"

namespace {
std::size_t allocations = 0;
}

// Not inlined: GCC 12 would take malloc's memory for new's.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) {
    return memory;
  }
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

namespace kidnapwatch::core {
namespace {

constexpr std::size_t kNoBand = std::numeric_limits<std::size_t>::max();

std::string described(Kind kind, std::size_t n, std::size_t m) {
  return std::string(kKindNames[static_cast<std::size_t>(kind)]) + " " + std::to_string(n) + "x" +
         std::to_string(m);
}

TEST(DtwKernel, HasTheBitsOfThePlainVersionAtEverySize) {
  DtwWorkspace workspace;
  for (std::size_t n = 1; n <= 400; ++n) {
    const Kind kind = kKinds[n % kKinds.size()];
    for (const std::size_t m : {n, 1 + n * 7919 % 400}) {
      Comparison comparison;
      comparison.add_points_and_ranges(pair_of(kind, n, m, n), workspace);
      ASSERT_EQ(comparison.mismatches(), 0) << described(kind, n, m);
    }
  }
}

TEST(DtwKernel, HasTheBitsOfThePlainVersionOnAllKindsOfScans) {
  DtwWorkspace workspace;
  for (const Kind kind : kKinds) {
    for (const auto& [n, m] : {std::pair<std::size_t, std::size_t>{1, 1},
                               {1, 300},
                               {2, 90},
                               {47, 48},
                               {48, 97},
                               {193, 5},
                               {360, 360},
                               {211, 389}}) {
      Comparison comparison;
      comparison.add_points_and_ranges(pair_of(kind, n, m, 5), workspace);
      EXPECT_EQ(comparison.mismatches(), 0) << described(kind, n, m);
    }
  }
}

TEST(DtwKernel, IsExactWhereABandIsTried) {
  DtwWorkspace workspace;
  workspace.band_from = 200;
  for (const Kind kind : kKinds) {
    for (const auto& [n, m] :
         {std::pair<std::size_t, std::size_t>{360, 360}, {500, 400}, {720, 720}, {701, 1081}}) {
      Comparison comparison;
      comparison.add_points_and_ranges(pair_of(kind, n, m, 6), workspace);
      EXPECT_EQ(comparison.mismatches(), 0) << described(kind, n, m);
    }
  }
}

/// Scans that agree but for a stretch seen much later: the path leaves any narrow band.
TEST(DtwKernel, IsExactWhereThePathLeavesTheBand) {
  DtwWorkspace workspace;
  workspace.band_from = 200;
  for (const std::size_t stretch : {30, 90, 150, 400}) {
    Pair pair = pair_of(Kind::identical, 800, 800, 7);
    const Cloud stay = dwelling_on({{pair.q.x[200]}, {pair.q.y[200]}}, stretch);
    const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    pair.q.x.insert(pair.q.x.begin() + at(200), stay.x.begin(), stay.x.end());
    pair.q.y.insert(pair.q.y.begin() + at(200), stay.y.begin(), stay.y.end());
    Comparison comparison;
    comparison.add_points_and_ranges(pair, workspace);
    EXPECT_EQ(comparison.mismatches(), 0) << stretch;
    EXPECT_EQ(dtw_cost(pair.p, pair.q, Precision::f32, workspace), 0.0) << stretch;
  }
}

TEST(DtwKernel, IsCloseToTheExactCostInF32) {
  DtwWorkspace workspace;
  Comparison comparison;
  for (const Kind kind : {Kind::normal, Kind::kidnap, Kind::random, Kind::dwelling}) {
    for (const std::size_t beams : {90, 181, 360, 720}) {
      comparison.add_points_and_ranges(pair_of(kind, beams, beams, beams), workspace);
    }
  }
  EXPECT_LT(comparison.largest_relative_error, 3e-6);
  EXPECT_GT(comparison.largest_relative_error, 0.0);
}

TEST(DtwKernel, IsSymmetricToTheBit) {
  DtwWorkspace workspace;
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    const auto [p, q] = pair_of(Kind::kidnap, 130, 371, 8);
    EXPECT_EQ(dtw_cost(p, q, precision, workspace), dtw_cost(q, p, precision, workspace));
  }
}

TEST(DtwKernel, WarpsInF64WhatF32CannotHold) {
  DtwWorkspace workspace;
  const auto [p, q] = pair_of(Kind::kidnap, 100, 90, 9);
  for (const double scale : {1e-300, 1e-40, 1e35, 1e200}) {
    const auto scaled = [scale](Cloud points) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        points.x[i] *= scale;
        points.y[i] *= scale;
      }
      return points;
    };
    const Cloud a = scaled(p);
    const Cloud b = scaled(q);
    EXPECT_EQ(dtw_cost(a, b, Precision::f32, workspace), dtw_cost(a, b)) << scale;
    EXPECT_EQ(dtw_cost(a.x, b.x, Precision::f32, workspace), dtw_cost(a.x, b.x)) << scale;
  }
}

TEST(DtwKernel, ForgetsThePairBefore) {
  DtwWorkspace used;
  for (const std::size_t beams : {700, 360, 1081, 40}) {
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      const auto [p, q] = pair_of(Kind::normal, beams, beams / 2, beams);
      DtwWorkspace fresh;
      EXPECT_EQ(dtw_cost(p, q, precision, used), dtw_cost(p, q, precision, fresh)) << beams;
    }
  }
}

TEST(DtwKernel, AllocatesNothingWhenWarm) {
  const auto [p, q] = pair_of(Kind::normal, 1081, 1000, 10);
  const auto [a, b] = pair_of(Kind::kidnap, 360, 341, 11);
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    DtwWorkspace workspace;
    std::ignore = dtw_cost(p, q, precision, workspace);
    const std::size_t before = allocations;
    std::ignore = dtw_cost(q, p, precision, workspace);
    std::ignore = dtw_cost(a, b, precision, workspace);
    std::ignore = dtw_cost(a.x, b.x, precision, workspace);
    EXPECT_EQ(allocations, before);
    workspace = {};
    std::ignore = dtw_cost(a, b, precision, workspace);
    EXPECT_GT(allocations, before);  // the counter counts
  }
}

TEST(DtwKernel, NeedsNoBandToBeExact) {
  DtwWorkspace banded;
  DtwWorkspace whole;
  whole.band_from = kNoBand;
  for (const Kind kind : kKinds) {
    const auto [p, q] = pair_of(kind, 1440, 1440, 12);
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      EXPECT_EQ(dtw_cost(p, q, precision, banded), dtw_cost(p, q, precision, whole))
          << described(kind, 1440, 1440);
    }
  }
}

}  // namespace
}  // namespace kidnapwatch::core
