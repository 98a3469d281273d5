// SPDX-License-Identifier: Apache-2.0
// Where the lidar says it moved between two scans: bounded point-to-line ICP.
#pragma once

#include <optional>

#include "core/contour.hpp"
#include "core/free_space.hpp"

namespace kidnapwatch::core {

struct AlignmentConfig {
  int iterations = 10;
  double reach_m = 0.5;  ///< farthest from its seed that an alignment may go
  double reach_rad = 0.45;
  float gate_m = 0.6F;       ///< farthest match, at first
  float gate_end_m = 0.15F;  ///< and in the end
  float gate_shrink = 0.8F;  ///< per iteration
  float outlier_m =
      0.05F;  ///< scale of the Cauchy weight, in the end; a third of the gate until then
  std::size_t points = 360;  ///< of `now` that are laid, at most; half as many while far off
  double weak = 0.03;        ///< share of the matches: directions they fix less are left alone
  double stop_m = 5e-4;
  double stop_rad = 5e-4;
};

/// One run of ICP.
struct Alignment {
  Pose motion;      ///< T_before_now of the sensor
  int matches = 0;  ///< points with a surface near
  int iterations = 0;
};

/// T_before_now nearest to `seed` that lays the points of `now` on the lines of `before`.
[[nodiscard]] Alignment aligned(const Contour& before, const Contour& now, const Pose& seed,
                                const AlignmentConfig& config);

/// The turn (rad, T_before_now) within +- reach_rad of `seed_rad` under which the ranges of both
/// scans are most alike; 1-D matching of the range profiles.
[[nodiscard]] double profile_turn_rad(const Contour& before, const Contour& now, double seed_rad,
                                      double reach_rad);

}  // namespace kidnapwatch::core
