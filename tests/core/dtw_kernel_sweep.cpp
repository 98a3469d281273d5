// SPDX-License-Identifier: Apache-2.0
// Holds the kernel to the plain versions over all sizes: dtw_kernel_sweep [FIRST LAST [STEP]]
//
// Every kind of pair of n x m beams, n from FIRST to LAST (1 to 400) in steps of STEP (1), m over a
// spread of widths; on points and on ranges, with a band and without, on all instruction sets of
// this processor. Prints the mismatches and exits with 1 if there are any.
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "tests/core/dtw_kernel_cases.hpp"

namespace {

using namespace kidnapwatch::core;

void add_widths(Kind kind, std::size_t n, Comparison& comparison) {
  DtwWorkspace whole;
  whole.band_from = std::numeric_limits<std::size_t>::max();
  DtwWorkspace banded;
  banded.band_from = 140;
  for (const std::size_t m : {n, 1 + n * 7919 % 400, std::size_t{1}, std::size_t{23},
                              std::size_t{64}, std::size_t{145}, std::size_t{360}}) {
    const Pair pair = pair_of(kind, n, m, 1000 * n + m);
    comparison.add_points_and_ranges(pair, whole);
    if (std::min(n, m) >= banded.band_from) {
      comparison.add_points_and_ranges(pair, banded);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int i, std::size_t otherwise) {
    return i < argc ? std::strtoull(argv[i], nullptr, 10) : otherwise;
  };
  std::size_t mismatches = 0;
  for (const Kind kind : kKinds) {
    Comparison comparison;
    for (std::size_t n = argument(1, 1); n <= argument(2, 400); n += argument(3, 1)) {
      add_widths(kind, n, comparison);
    }
    std::printf(
        "%-10s %8zu costs on %zu instruction sets: %zu + %zu mismatches in f64 + f32, "
        "f32 off by at most %.2g\n",
        kKindNames[static_cast<std::size_t>(kind)].data(), comparison.costs, comparison.sets.size(),
        comparison.f64_mismatches, comparison.f32_mismatches, comparison.largest_relative_error);
    std::fflush(stdout);
    mismatches += comparison.mismatches();
  }
  return mismatches == 0 ? 0 : 1;
}
