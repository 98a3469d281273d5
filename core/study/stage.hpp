// SPDX-License-Identifier: Apache-2.0
// Where trials are run: a world, its map, the robot's lidar, and the systems under test.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/baselines/mcl.hpp"
#include "core/study/algorithm2.hpp"

namespace kidnapwatch::core::study {

/// Which systems to run; the time of a trial is theirs.
struct Systems {
  bool dtw = true;  ///< all readings of the six variants: 0.2 s a trial
  bool ndt = true;  ///< 0.2 s
  bool mcl = true;  ///< with every relocalization: 8 s
};

struct Setting {
  double range_max_m = 3.5;
  double noise_variance_m2 = 0.1;
  std::size_t steps = 100;  ///< T
  std::size_t particles = 2000;
  Systems systems;
};

/// Unchanging: trials can be run on it by several threads at once.
class Stage {
 public:
  Stage(const sim::World& world, const Setting& setting);

  /// All systems through Algorithm 2: pure, the same for the same seed.
  [[nodiscard]] std::vector<TrialRecord> trial(std::uint64_t seed) const;

  [[nodiscard]] const std::string& map() const { return world_.name; }
  [[nodiscard]] const Setting& setting() const { return setting_; }

 private:
  sim::World world_;
  Setting setting_;
  std::optional<baselines::MeasuredMap> map_;
};

}  // namespace kidnapwatch::core::study
