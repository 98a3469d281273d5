// SPDX-License-Identifier: Apache-2.0
// Kidnappings cut into recorded runs, so that real scans can be had of them (the paper's section
// 4).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recording.hpp"

namespace kidnapwatch::core::evaluation {

/// At `at_s` the robot is taken to where the recording was at `to_s`.
struct Cut {
  double at_s = 0.0;  ///< after the first scan, in the spliced run
  double to_s = 0.0;  ///< after the first scan, in the recording

  friend bool operator==(const Cut&, const Cut&) = default;
};

struct Spliced {
  Recording recording;
  std::vector<std::size_t> first_after;  ///< per cut: index of the first scan elsewhere
};

/// The recording with the cuts in it: from the first scan at or after at_s on, its scans are
/// replaced by those from to_s on, to the recording's end or the next cut.
///
/// Nothing but the scans tells of a cut: the first scan elsewhere gets stamp and odometry of the
/// one that it replaces, and both go on from there as they were recorded. Without odometry in one
/// of these two, the run has none after the cut. True poses stay those of the scans.
///
/// Cuts are in order of at_s. Throws BadInput naming `at_s` or `to_s` unless there is a scan before
/// the cut, one that it replaces, and one to go to.
[[nodiscard]] Spliced splice(const Recording& recording, std::span<const Cut> cuts);

struct FarJumpConfig {
  double min_distance_m = 3.0;
  std::size_t scans_before = 120;  ///< the cut, for a detector to warm up
  std::size_t scans_after = 20;    ///< the cut, for a detector to make up its mind
};

/// A cut in the middle of the recording, or later where scans_before wants it, to the place that is
/// farthest away by true poses or, without them, by odometry; of equally far ones to the earliest.
/// Nothing if no place is min_distance_m away or the recording is too short.
[[nodiscard]] std::optional<Cut> far_jump(const Recording& recording,
                                          const FarJumpConfig& config = {});

}  // namespace kidnapwatch::core::evaluation
