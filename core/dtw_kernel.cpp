// SPDX-License-Identifier: Apache-2.0
// Exact dynamic time warping on the processor's vector units. Algorithm 1 (lines 3-5).
//
// Compiled once per instruction set (Highway's foreach_target); the best that the processor has is
// chosen when first called. Every one of them computes the same sums, so all give the same bits.

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // false alarms in GCC 12's AVX-512 headers
#endif

#include "core/dtw_kernel.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

// Processors with SSSE3 alone have died out; SVE's vectors cannot be members of arrays.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/dtw_kernel.cpp"
#include <hwy/foreach_target.h>  // before highway.h
#include <hwy/highway.h>

#include "core/dtw_strips-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace kidnapwatch::core::HWY_NAMESPACE {
namespace {

/// A sequence of points (two axes) or of ranges (one axis, given twice).
struct Sequence {
  std::size_t size;
  const double* axis[2];
};

/// How to sweep a matrix: rows per lane, and the steps of the wavefront weighed with their cost.
struct Plan {
  std::size_t depth;
  std::size_t work;

  friend bool operator<(const Plan& a, const Plan& b) { return a.work < b.work; }
};

template <class Metric, std::size_t kDepth>
Plan plan(std::size_t rows, std::size_t columns, std::size_t half_width) {
  using Front = Wavefront<Metric, kDepth>;
  const std::size_t before_last = (rows - 1) / Front::kHeight;
  const std::size_t last_lane = (rows - 1) % Front::kHeight / kDepth;
  const std::size_t whole = before_last > 0 ? std::max(columns, Front::kFront) : columns;
  const std::size_t width = std::min(whole, Front::kHeight * columns / rows + 2 * half_width);
  const std::size_t steps = (before_last + 1) * (width + 1) + last_lane;
  return {kDepth, steps * (2 * kDepth + 1)};  // measured: a step takes 5 : 7 : 9
}

/// Without vectors there is nothing to choose, and less to compile.
template <class Metric>
constexpr bool kHasVectors = Wavefront<Metric, 2>::kLanes > 1;

template <class Metric>
Plan best_plan(std::size_t rows, std::size_t columns, std::size_t half_width) {
  Plan best = plan<Metric, 2>(rows, columns, half_width);
  if constexpr (kHasVectors<Metric>) {
    best = std::min({best, plan<Metric, 3>(rows, columns, half_width),
                     plan<Metric, 4>(rows, columns, half_width)});
  }
  return best;
}

template <class Metric>
Warped<typename Metric::Real> warped(const Matrix<typename Metric::Real>& x, std::size_t depth,
                                     std::size_t half_width) {
  if constexpr (kHasVectors<Metric>) {
    if (depth == 3) {
      return Strips<Metric, 3>(x, half_width).swept();
    }
    if (depth == 4) {
      return Strips<Metric, 4>(x, half_width).swept();
    }
  }
  return Strips<Metric, 2>(x, half_width).swept();
}

/// Within a band, if one can be found that is certain and saves time. A band that was too narrow
/// tells how wide it should have been: its rim costs about in proportion to its distance.
template <class Metric>
std::optional<double> cost_in_band(const Matrix<typename Metric::Real>& x,
                                   std::size_t work_of_whole) {
  // A ninth holds the paths of most successive scans; measured at 540 to 4320 beams.
  std::size_t half_width = std::max(x.columns / 9, kMaxFront);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const Plan plan = best_plan<Metric>(x.rows, x.columns, half_width);
    if (plan.work > work_of_whole / 10 * 6) {
      break;
    }
    const auto found = warped<Metric>(x, plan.depth, half_width);
    if (found.is_exact()) {
      return found.cost;
    }
    const double wider = 1.15 * static_cast<double>(found.cost) / static_cast<double>(found.rim);
    half_width = static_cast<std::size_t>(static_cast<double>(half_width) * std::min(wider, 9.0));
  }
  return std::nullopt;
}

template <class Metric>
double cheapest_path(Matrix<typename Metric::Real>& x, std::size_t band_from) {
  const std::size_t whole = x.rows + x.columns;
  Plan plan = best_plan<Metric>(x.rows, x.columns, whole);
  const Plan transposed = best_plan<Metric>(x.columns, x.rows, whole);
  if (transposed < plan) {  // the cost is the same, to the bit
    std::swap(x.rows, x.columns);
    std::swap(x.p, x.q);
    plan = transposed;
  }
  if (std::min(x.rows, x.columns) >= band_from) {
    if (const auto cost = cost_in_band<Metric>(x, plan.work)) {
      return *cost;
    }
  }
  return warped<Metric>(x, plan.depth, whole).cost;
}

/// A matrix in `memory`, its arrays 1 KiB apart modulo 4 KiB: a load whose address ends in the same
/// 12 bits as that of a store before it has to wait for that, which can halve the speed.
template <class Real>
Matrix<Real> laid_out(std::size_t rows, std::size_t columns, std::vector<Real>& memory) {
  constexpr std::size_t kPage = 4096 / sizeof(Real);
  const std::size_t size = std::max(rows, columns) + 2 * kMargin;
  const std::size_t stride = (size + kPage - 1) / kPage * kPage + kPage / 4;
  if (memory.size() < 5 * stride) {
    memory.resize(5 * stride);
  }
  Real* const at = memory.data() + kMargin;
  return {rows, columns, {at, at + stride}, {at + 2 * stride, at + 3 * stride}, at + 4 * stride};
}

/// Writes points as the metric needs them.
void convert(RotatedL1 /*metric*/, const Sequence& points, float* const* to) {
  const auto [x, y] = points.axis;
  for (std::size_t i = 0; i < points.size; ++i) {
    to[0][i] = static_cast<float>(x[i] + y[i]);
    to[1][i] = static_cast<float>(x[i] - y[i]);
  }
}

template <class Metric>
void convert(Metric /*metric*/, const Sequence& points, typename Metric::Real* const* to) {
  for (std::size_t a = 0; a < Metric::kAxes; ++a) {
    std::copy_n(points.axis[a], points.size, to[a]);
  }
}

/// Whether the values are so large or so small that f32 would lose more than their last bits.
bool exceeds_f32(const float* values, std::size_t count) {
  const hn::ScalableTag<float> d;
  auto high = hn::Zero(d);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    high = hn::Max(high, hn::Abs(hn::LoadU(d, values + i)));
  }
  float largest = hn::GetLane(hn::MaxOfLanes(d, high));
  for (; i < count; ++i) {
    largest = std::max(largest, std::abs(values[i]));
  }
  return largest > 1e30F || largest < 1e-30F;
}

/// Nothing if Metric's arithmetic does not hold the points.
template <class Metric>
std::optional<double> cost(const Sequence& p, const Sequence& q,
                           std::vector<typename Metric::Real>& memory, std::size_t band_from) {
  auto x = laid_out(p.size, q.size, memory);
  convert(Metric(), p, x.p);
  convert(Metric(), q, x.q);
  if constexpr (sizeof(typename Metric::Real) == sizeof(float)) {
    for (std::size_t a = 0; a < Metric::kAxes; ++a) {
      if (exceeds_f32(x.p[a], p.size) || exceeds_f32(x.q[a], q.size)) {
        return std::nullopt;
      }
    }
  }
  return cheapest_path<Metric>(x, band_from);
}

template <class MetricF32, class MetricF64>
double cost(const Sequence& p, const Sequence& q, Precision precision, DtwWorkspace& workspace) {
  if (precision == Precision::f32) {
    if (const auto f32 = cost<MetricF32>(p, q, workspace.f32, workspace.band_from)) {
      return *f32;
    }
  }
  return *cost<MetricF64>(p, q, workspace.f64, workspace.band_from);
}

double cost_of_points(const Cloud& p, const Cloud& q, Precision precision,
                      DtwWorkspace& workspace) {
  return cost<RotatedL1, PlainL1>({p.size(), {p.x.data(), p.y.data()}},
                                  {q.size(), {q.x.data(), q.y.data()}}, precision, workspace);
}

double cost_of_ranges(std::span<const double> p, std::span<const double> q, Precision precision,
                      DtwWorkspace& workspace) {
  return cost<OneAxis<float>, OneAxis<double>>(
      {p.size(), {p.data(), p.data()}}, {q.size(), {q.data(), q.data()}}, precision, workspace);
}

}  // namespace
}  // namespace kidnapwatch::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kidnapwatch::core {
namespace {
HWY_EXPORT(cost_of_points);
HWY_EXPORT(cost_of_ranges);
}  // namespace

double dtw_cost(const Cloud& p, const Cloud& q, Precision precision, DtwWorkspace& workspace) {
  assert(p.size() > 0 && q.size() > 0);
  return HWY_DYNAMIC_DISPATCH(cost_of_points)(p, q, precision, workspace);
}

double dtw_cost(std::span<const double> p, std::span<const double> q, Precision precision,
                DtwWorkspace& workspace) {
  assert(!p.empty() && !q.empty());
  return HWY_DYNAMIC_DISPATCH(cost_of_ranges)(p, q, precision, workspace);
}

}  // namespace kidnapwatch::core
#endif  // HWY_ONCE
