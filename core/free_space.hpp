// SPDX-License-Identifier: Apache-2.0
// Do two scans contradict each other? Points of one that lie where the other saw through.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/contour.hpp"
#include "core/pose.hpp"

namespace kidnapwatch::core {

inline constexpr std::size_t kSectors = 12;  ///< of bearing, in each of the two scans

/// How many points were held against the other scan, and what came out.
struct Tally {
  float points = 0.0F;      ///< in the other's field of view
  float consistent = 0.0F;  ///< where the other scan has a surface too
  float violating = 0.0F;   ///< where it saw through
};

/// The points of `now` by the sector of `before` they lie in, then the reverse.
using Tallies = std::array<Tally, 2 * kSectors>;

/// Holds the points of each scan against the free space of the other. `motion` is T_before_now of
/// the sensor. A point is consistent within 0.10 m + 3 % of its range of what a beam and its two
/// neighbours measured; nearer, it violates; farther, it is hidden and says nothing. Where the
/// other scan saw nothing at all, a point within 0.8 range_max violates, unless its own scan saw
/// nothing along that beam either (parts of a robot stand in the way of its lidar): that says
/// nothing. What is in the foreground
/// (Contour::foreground) never violates, and what it hides does not count.
[[nodiscard]] Tallies contradictions(const Contour& before, const Contour& now, const Pose& motion);

/// The beams of `seen` whose points lie where `observer` saw through, if `pose` is T_observer_seen.
[[nodiscard]] std::vector<std::size_t> violating_beams(const Contour& observer, const Contour& seen,
                                                       const Pose& pose);

/// What the tallies come to, as shares of the points, 0..1.
struct Agreement {
  std::size_t sectors = 0;  ///< that hold at least 4 points
  float consistent = 0.0F;
  float violating = 0.0F;
  /// The same without the worst quarter of the sectors: what people and doors, who fill a few
  /// sectors, cannot spoil.
  float consistent_elsewhere = 0.0F;
  float violating_elsewhere = 0.0F;

  /// How well two scans fit: the pose that maximises it is the better of two alignments.
  [[nodiscard]] float quality() const { return consistent - 2.0F * violating; }
};

[[nodiscard]] Agreement agreement(const Tallies& tallies);

}  // namespace kidnapwatch::core
