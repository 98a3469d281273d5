// SPDX-License-Identifier: Apache-2.0
// One trial of Algorithm 2: a simulated run, and what follows if the robot is kidnapped in it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/recording.hpp"
#include "core/sim/drive.hpp"

namespace kidnapwatch::core::study {

/// The defaults are the paper's: a TurtleBot3's LDS-01 with range noise of variance 0.1 m^2, and
/// T = 100. A step is 1 s, in which the robot drives 0.22 m.
struct TrialConfig {
  sim::RobotModel robot{.range_noise_sd_m = 0.31622776601683794, .turn_rate_radps = 0.3};
  std::size_t steps = 100;  ///< T
  double step_s = 1.0;
};

/// The scans that all kidnappings of one trial are made of.
struct Trial {
  std::vector<RecordedScan> run;    ///< T natural steps from the beginning of the tour
  std::vector<RecordedScan> after;  ///< T steps from elsewhere: what follows, whenever it happens
};

/// Drives it. The same world, config and seed give the same trial.
[[nodiscard]] Trial drive(const sim::World& world, const TrialConfig& config, std::uint64_t seed);

/// Algorithm 2, line 3: natural steps 1..t_k - 1, then T - t_k + 1 steps elsewhere, of which stamps
/// and odometry tell nothing. 2 <= t_k <= T.
[[nodiscard]] Recording kidnapped_at(const Trial& trial, std::size_t t_k);

}  // namespace kidnapwatch::core::study
