// SPDX-License-Identifier: Apache-2.0
// A few scans to put after a recorded run: what a robot would send if something had happened.
#pragma once

#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include "core/recording.hpp"

namespace kidnapwatch::core::evaluation {

/// The scans that follow recording.scans[at - 1] instead of its own.
struct Episode {
  std::size_t at = 0;
  std::vector<Scan> scans;
};

using Random = std::mt19937_64;

/// Uniform in [low, high): the same on every platform.
[[nodiscard]] double uniform(Random& random, double low, double high);
/// An index below `size` (> 0).
[[nodiscard]] std::size_t pick(Random& random, std::size_t size);
/// Normal with standard deviation `sd`.
[[nodiscard]] double gaussian(Random& random, double sd);

/// Where the robot was: the true pose, else odometry, else nothing.
[[nodiscard]] std::optional<Pose> pose_of(const RecordedScan& recorded);

/// `count` scans of the recording from `from` on, told as if they followed recording.scans[at - 1]:
/// their stamps go on from there as recorded, and so does odometry from `first`, the motion told
/// between the last scan before and the first of these. Nothing if the recording is too short.
[[nodiscard]] std::optional<Episode> relocated(const Recording& recording, std::size_t at,
                                               std::size_t from, std::size_t count,
                                               const Pose& first);

/// The motion that odometry tells between two scans; none without odometry.
[[nodiscard]] Pose told_motion(const Recording& recording, std::size_t from, std::size_t to);

/// Scans of the recording as they are, from `from` on, after recording.scans[at - 1].
[[nodiscard]] std::optional<Episode> excerpt(const Recording& recording, std::size_t at,
                                             std::size_t from, std::size_t count);

}  // namespace kidnapwatch::core::evaluation
