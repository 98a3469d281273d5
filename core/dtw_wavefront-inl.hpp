// SPDX-License-Identifier: Apache-2.0
// A skewed wavefront of dynamic time warping in vector registers, once per instruction set.

// Highway's idiom: included again for every target.
#if defined(KIDNAPWATCH_CORE_DTW_WAVEFRONT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef KIDNAPWATCH_CORE_DTW_WAVEFRONT_INL
#undef KIDNAPWATCH_CORE_DTW_WAVEFRONT_INL
#else
#define KIDNAPWATCH_CORE_DTW_WAVEFRONT_INL
#endif

#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kidnapwatch::core::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#define KW_IS_AVX512 (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3)

/// Keeps `v` in a register: GCC 12 otherwise folds one load into several subtractions and loads
/// across two cache lines for each of them. 15 % with two or three rows in a lane; with four, and
/// with the 16 registers below AVX-512, there is none to spare.
template <std::size_t kDepth, class V>
HWY_INLINE void keep_in_register([[maybe_unused]] V& v) {
#if KW_IS_AVX512
  if constexpr (kDepth < 4) {
    asm("" : "+v"(v.raw));
  }
#endif
}

/// v[1], v[2], ..., next[0]: every lane takes over from the lane above it.
template <class V>
HWY_INLINE V shifted_in(V next, [[maybe_unused]] V v) {
#if HWY_TARGET == HWY_SCALAR
  return next;
#elif KW_IS_AVX512  // Highway 1.0.3 shifts within blocks of 16 bytes only
  if constexpr (sizeof(hn::TFromV<V>) == sizeof(float)) {
    return V{_mm512_castsi512_ps(
        _mm512_alignr_epi32(_mm512_castps_si512(next.raw), _mm512_castps_si512(v.raw), 1))};
  } else {
    return V{_mm512_castsi512_pd(
        _mm512_alignr_epi64(_mm512_castpd_si512(next.raw), _mm512_castpd_si512(v.raw), 1))};
  }
#elif HWY_TARGET == HWY_AVX2
  if constexpr (sizeof(hn::TFromV<V>) == sizeof(float)) {
    return V{_mm256_permutevar8x32_ps(_mm256_blend_ps(v.raw, next.raw, 1),
                                      _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0))};
  } else {
    return V{_mm256_permute4x64_pd(_mm256_blend_pd(v.raw, next.raw, 1), 0b00111001)};
  }
#else
  return hn::CombineShiftRightLanes<1>(hn::DFromV<V>(), next, v);
#endif
}

/// L1 distance of points given as (x + y, x - y): |dx| + |dy| = max(|du|, |dv|), one operation
/// less.
struct RotatedL1 {
  using Real = float;
  static constexpr std::size_t kAxes = 2;

  template <class V>
  static HWY_INLINE V distance(const V* p, V u, V v) {
#if KW_IS_AVX512
    constexpr int kMaxOfMagnitudes = 0b1011;
    return V{_mm512_range_ps(hn::Sub(u, p[0]).raw, hn::Sub(v, p[1]).raw, kMaxOfMagnitudes)};
#else
    return hn::Max(hn::Abs(hn::Sub(u, p[0])), hn::Abs(hn::Sub(v, p[1])));
#endif
  }
};

/// L1 distance of points given as (x, y), as the plain version computes it.
struct PlainL1 {
  using Real = double;
  static constexpr std::size_t kAxes = 2;

  template <class V>
  static HWY_INLINE V distance(const V* p, V x, V y) {
    return hn::Add(hn::Abs(hn::Sub(x, p[0])), hn::Abs(hn::Sub(y, p[1])));
  }
};

/// Distance of ranges.
template <class Number>
struct OneAxis {
  using Real = Number;
  static constexpr std::size_t kAxes = 1;

  template <class V>
  static HWY_INLINE V distance(const V* p, V x, V /*unused*/) {
    return hn::Abs(hn::Sub(x, p[0]));
  }
};

/// kFront lanes next to each other down the matrix, each of them kDepth rows deep and one column
/// behind the lane above it, so that all cells of one step are independent between lanes. Lane 0 is
/// the lowest: the columns that the lanes need are then neighbours in memory, in ascending order.
///
/// Three vectors (four on one axis) hide the latency of the chain through the rows of a lane, and
/// more would not fit into the registers.
template <class Metric, std::size_t kDepth>
struct Wavefront {
  using Real = typename Metric::Real;
  using Tag = hn::ScalableTag<Real>;
  using V = hn::Vec<Tag>;
  static constexpr std::size_t kAxes = Metric::kAxes;
  static constexpr std::size_t kVectors = kAxes == 2 ? 3 : 4;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag());
  static constexpr std::size_t kFront = kVectors * kLanes;
  static constexpr std::size_t kHeight = kFront * kDepth;

  V p[kVectors][kDepth][kAxes];  // the points of the lanes' rows
  V left[kVectors][kDepth];      // D(i, j-1)
  V corner[kVectors];            // D(i-1, j-1) of the lanes' upper rows

  /// Advances every lane by one column. `q` and `at`: the column of lane 0; `above`: D over the
  /// uppermost lane; `below`: where the lowest row goes. Its upper neighbours come along, for
  /// columns that the lowest row reaches later.
  HWY_INLINE void step(const Real* const* q, std::size_t at, Real above, Real* below) {
    const Tag d;
    HWY_UNROLL(4)
    for (std::size_t s = 0; s < kVectors; ++s) {
      const V over = s + 1 < kVectors ? left[(s + 1) % kVectors][kDepth - 1] : hn::Set(d, above);
      V up = shifted_in(over, left[s][kDepth - 1]);
      V diagonal = corner[s];
      corner[s] = up;
      V x = hn::LoadU(d, q[0] + at + s * kLanes);
      V y = x;
      keep_in_register<kDepth>(x);
      if constexpr (kAxes == 2) {
        y = hn::LoadU(d, q[1] + at + s * kLanes);
        keep_in_register<kDepth>(y);
      }
      HWY_UNROLL(4)
      for (std::size_t r = 0; r < kDepth; ++r) {
        // `up` last: it alone was computed just before.
        const V best = hn::Min(hn::Min(diagonal, left[s][r]), up);
        up = hn::Add(Metric::distance(p[s][r], x, y), best);
        diagonal = left[s][r];
        left[s][r] = up;
      }
    }
    hn::StoreU(left[0][kDepth - 1], d, below);
  }
};

}  // namespace kidnapwatch::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
