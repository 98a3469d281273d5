// SPDX-License-Identifier: Apache-2.0
// The paper's section 5 on recorded runs: every natural pair of scans, and kidnappings cut in.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/recording.hpp"
#include "core/study/algorithm2.hpp"

namespace kidnapwatch::core::study {

struct RecordedConfig {
  std::size_t kidnappings = 100;  ///< cut into each run
  double least_distance_m = 3.0;  ///< by true poses; without them, by odometry
  std::uint64_t seed = 1;
  std::size_t particles = 0;  ///< of Monte Carlo localization; 0: none of its scores
  Polarity me_polarity = Polarity::lptf;
};

/// Scores of one run, a row per scan, a column per detector.
struct RecordedScores {
  std::string name;
  std::vector<std::string> ids;
  std::vector<Polarity> polarities;
  std::vector<std::vector<double>> natural;
  std::vector<std::vector<double>> kidnapped;
};

/// Where the robot is taken from (the scan before), and where to (the scan after), is drawn from
/// the poses alone, among the comparable scans. A kidnapping is shown to fresh detectors as two
/// scans, with the odometry of the natural pair. Scans that a detector has no finite score for are
/// left out; there may be fewer kidnappings than asked for, or none, where few places are far
/// apart.
///
/// "mcw" and "me", in the last columns, are those of a filter along the run in the map of its own
/// scans (baselines::poses_of), put right where it is lost; a copy of it is shown each kidnapping.
/// Between scans without odometry it is told the motion between these poses. Throws BadInput naming
/// `map` where that would be too large.
[[nodiscard]] RecordedScores recorded_scores(const Recording& recording,
                                             const std::function<Detectors()>& make,
                                             const RecordedConfig& config = {});

}  // namespace kidnapwatch::core::study
