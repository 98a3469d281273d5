// SPDX-License-Identifier: Apache-2.0
// Endless strips: a whole matrix, or a band of it, swept by one wavefront that never drains.
//
// The matrix is cut into strips of rows. A wavefront sweeps a strip from left to right in
// registers; only the strip's lowest row goes through memory, to be the upper border of the next
// strip. A lane that has done its last column starts on the next strip at once, so that filling the
// wavefront is paid for once and not per strip.
//
// Between two strips every lane meets a column of points at infinity. Its cells cost infinity,
// which is what Algorithm 1 has outside of the matrix.

#if defined(KIDNAPWATCH_CORE_DTW_STRIPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef KIDNAPWATCH_CORE_DTW_STRIPS_INL
#undef KIDNAPWATCH_CORE_DTW_STRIPS_INL
#else
#define KIDNAPWATCH_CORE_DTW_STRIPS_INL
#endif

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

#include "core/dtw_wavefront-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace kidnapwatch::core::HWY_NAMESPACE {

/// Rows of p against columns of q. Before and behind every array are kMargin values that may be
/// read and, in `row`, written; their values never matter.
template <class Real>
struct Matrix {
  std::size_t rows;
  std::size_t columns;
  Real* p[2];  // by axis
  Real* q[2];
  Real* row;  // costs along the lower border of a strip
};
inline constexpr std::size_t kMargin = 256;
inline constexpr std::size_t kMaxFront = 64;

/// What a sweep found.
template <class Real>
struct Warped {
  Real cost;  ///< of the cheapest path within the band; an estimate of it if given up
  Real rim;   ///< of the cheapest way to the band's rim; infinite if the band is the whole matrix

  /// A path that leaves the band has been at its rim, and no path ever becomes cheaper.
  [[nodiscard]] bool is_exact() const { return cost <= rim; }
};

/// The least of `count` values; infinity if there is none.
template <class Real>
Real least(const Real* values, std::size_t count) {
  const hn::ScalableTag<Real> d;
  auto low = hn::Set(d, std::numeric_limits<Real>::infinity());
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    low = hn::Min(low, hn::LoadU(d, values + i));
  }
  Real result = hn::GetLane(hn::MinOfLanes(d, low));
  for (; i < count; ++i) {
    result = std::min(result, values[i]);
  }
  return result;
}

template <class Metric, std::size_t kDepth>
class Strips {
  using Front = Wavefront<Metric, kDepth>;
  using Real = typename Front::Real;
  using V = typename Front::V;
  using Index = std::ptrdiff_t;
  static constexpr std::size_t kAxes = Front::kAxes;
  static constexpr std::size_t kVectors = Front::kVectors;
  static constexpr std::size_t kLanes = Front::kLanes;
  static constexpr std::size_t kFront = Front::kFront;
  static constexpr std::size_t kHeight = Front::kHeight;
  static constexpr Real kNoPath = std::numeric_limits<Real>::infinity();
  static_assert(kFront <= kMaxFront && kHeight <= kMargin);

 public:
  /// The band is what lies within `half_width` columns of the matrix's diagonal, and at least as
  /// wide to each side as the wavefront; or the whole matrix.
  Strips(const Matrix<Real>& matrix, std::size_t half_width)
      : x_(matrix),
        half_width_(half_width),
        strips_((matrix.rows + kHeight - 1) / kHeight),
        // The wavefront's lower end has to be done with a column before its upper end is back.
        width_(strips_ > 1 ? std::max(matrix.columns, kFront) : matrix.columns) {
    assert(half_width >= kFront || !is_banded());
  }

  /// Algorithm 1, lines 3-5. Gives up when the path must cost more than the rim, or is going to: on
  /// kidnappings the attempt then takes 2 % of the time of the whole matrix, not 10 %.
  HWY_INLINE Warped<Real> swept() {
    start();
    Columns before = kNone;
    for (std::size_t k = 0; k < strips_; ++k) {
      const Columns now = columns(k);
      const std::size_t steps = steps_in(k, now);
      stitch(before, now);
      hand_over(k, before, now, steps);
      x_.row[-1] = kNoPath;
      if (is_banded() && k > 0) {
        const Real border = closed(before, now);
        const Real estimate = border * static_cast<Real>(x_.rows) / static_cast<Real>(k * kHeight);
        if (border > rim_ || estimate > 2 * rim_) {
          return {estimate, rim_};
        }
      }
      sweep(now, steps);
      before = now;
    }
    return {last_cell(), rim_};
  }

 private:
  struct Columns {
    Index first;
    Index last;
  };
  static constexpr Columns kNone{0, -2};  // before the first strip; its lower border is left of 0

  [[nodiscard]] bool is_banded() const { return half_width_ < width_; }

  /// Those of strip `k`.
  [[nodiscard]] Columns columns(std::size_t k) const {
    const std::size_t lower = std::min((k + 1) * kHeight, x_.rows);
    const std::size_t first = k * kHeight * x_.columns / x_.rows;
    const std::size_t last = lower * x_.columns / x_.rows + half_width_;
    return {static_cast<Index>(first - std::min(first, half_width_)),
            static_cast<Index>(std::min(last, width_ - 1))};
  }

  /// The column at infinity and all others. In the last strip until the lane with the last row has
  /// done the last column.
  [[nodiscard]] std::size_t steps_in(std::size_t k, Columns now) const {
    return k + 1 < strips_ ? static_cast<std::size_t>(now.last - now.first) + 2
                           : x_.columns - static_cast<std::size_t>(now.first) + 1 + last_lane();
  }

  /// Counted from the top.
  [[nodiscard]] std::size_t last_lane() const { return (x_.rows - 1) % kHeight / kDepth; }

  void start() {
    const typename Front::Tag d;
    std::fill_n(x_.row, width_, kNoPath);
    x_.row[-1] = 0;  // every path starts in the corner before the first cell
    for (std::size_t s = 0; s < kVectors; ++s) {
      for (std::size_t r = 0; r < kDepth; ++r) {
        front_.left[s][r] = hn::Set(d, kNoPath);
        for (std::size_t a = 0; a < kAxes; ++a) {
          front_.p[s][r][a] = hn::Zero(d);
        }
      }
      front_.corner[s] = hn::Set(d, kNoPath);
    }
  }

  /// The columns that the lanes meet while they change strips: the last before, infinity, the first
  /// now.
  void stitch(Columns before, Columns now) {
    for (std::size_t a = 0; a < kAxes; ++a) {
      if (before.last >= 0) {
        std::copy_n(x_.q[a] + before.last + 2 - kFront, kFront - 1, seam_[a]);
      }
      seam_[a][kFront - 1] = kNoPath;
      std::copy_n(x_.q[a] + now.first, kFront - 1, seam_[a] + kFront);
    }
  }

  /// The rows that the lanes take over in strip `k`.
  void load_rows(std::size_t k) {
    const typename Front::Tag d;
    for (std::size_t s = 0; s < kVectors; ++s) {
      for (std::size_t a = 0; a < kAxes; ++a) {
        const Real* from = x_.p[a] + k * kHeight + (kFront - (s + 1) * kLanes) * kDepth;
        V row[4];
        if constexpr (kDepth == 2) {
          hn::LoadInterleaved2(d, from, row[0], row[1]);
        } else if constexpr (kDepth == 3) {
          hn::LoadInterleaved3(d, from, row[0], row[1], row[2]);
        } else {
          hn::LoadInterleaved4(d, from, row[0], row[1], row[2], row[3]);
        }
        for (std::size_t r = 0; r < kDepth; ++r) {
          rows_[s][r][a] = hn::Reverse(d, row[r]);
        }
      }
    }
  }

  /// kFront steps, in each of which one lane starts on strip `k`, the uppermost first.
  HWY_INLINE void hand_over(std::size_t k, Columns before, Columns now, std::size_t steps) {
    load_rows(k);
    const Real* seam[2] = {seam_[0], seam_[1]};
    const Real* above = x_.row + now.first - 1;
    Real* below = x_.row + before.last + 2 - kFront;
    const bool has_rim = is_banded() && k > 0 && before.last + 1 < static_cast<Index>(width_);
    Front front = front_;
    for (std::size_t t = 0; t < std::min(steps, kFront); ++t) {
      const std::size_t lane = kFront - 1 - t;
      HWY_UNROLL(4)
      for (std::size_t s = 0; s < kVectors; ++s) {
        if (lane / kLanes == s) {
          if (has_rim) {
            note_rim(front.left[s], lane % kLanes);
          }
          start_lane(front.p[s], rows_[s], lane % kLanes);
        }
      }
      front.step(seam, t, above[t], below + t);
    }
    front_ = front;
  }

  /// The lanes below go on with their rows.
  HWY_INLINE void start_lane(V (&p)[kDepth][kAxes], const V (&rows)[kDepth][kAxes],
                             std::size_t lane) {
    const auto stays = hn::FirstN(typename Front::Tag(), lane);
    HWY_UNROLL(4)
    for (std::size_t r = 0; r < kDepth; ++r) {
      for (std::size_t a = 0; a < kAxes; ++a) {
        p[r][a] = hn::IfThenElse(stays, p[r][a], rows[r][a]);
      }
    }
  }

  /// The right ends of a lane's rows are a part of the rim.
  HWY_INLINE void note_rim(const V* left, std::size_t lane) {
    const typename Front::Tag d;
    HWY_ALIGN Real lanes[kLanes];
    V low = left[0];
    for (std::size_t r = 1; r < kDepth; ++r) {
      low = hn::Min(low, left[r]);
    }
    hn::Store(low, d, lanes);
    rim_ = std::min(rim_, lanes[lane]);
  }

  /// Closes the strip before: what the next one does not continue is a part of the rim, and what
  /// that adds on the right has no path from above. The cheapest way on, which every path within
  /// the band has to take.
  Real closed(Columns before, Columns now) {
    const auto count = [](Index first, Index end) { return static_cast<std::size_t>(end - first); };
    rim_ = std::min(rim_, least(x_.row + before.first, count(before.first, now.first)));
    std::fill(x_.row + before.last + 1, x_.row + now.last + 1, kNoPath);
    return least(x_.row + now.first, count(now.first, before.last + 1));
  }

  /// The rest of a strip, when all lanes are in it.
  HWY_INLINE void sweep(Columns now, std::size_t steps) {
    const Real* q[2] = {x_.q[0] + now.first, x_.q[1] + now.first};
    const Real* above = x_.row + now.first - 1;
    Real* below = x_.row + now.first;
    Front front = front_;
    for (std::size_t t = kFront; t < steps; ++t) {
      front.step(q, t - kFront, above[t], below + (t - kFront));
    }
    front_ = front;
  }

  [[nodiscard]] Real last_cell() const {
    const typename Front::Tag d;
    HWY_ALIGN Real lanes[kLanes];
    const std::size_t lane = kFront - 1 - last_lane();
    hn::Store(front_.left[lane / kLanes][(x_.rows - 1) % kDepth], d, lanes);
    return lanes[lane % kLanes];
  }

  const Matrix<Real>& x_;
  std::size_t half_width_;
  std::size_t strips_;
  std::size_t width_;  // columns that are swept, the last of them for nothing if there are few
  Front front_;
  V rows_[kVectors][kDepth][kAxes];  // that the lanes take over in the next strip
  Real rim_ = kNoPath;
  HWY_ALIGN Real seam_[2][2 * kFront] = {};
};

}  // namespace kidnapwatch::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
