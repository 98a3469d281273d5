// SPDX-License-Identifier: Apache-2.0
// A robot's run, whole: what a log holds and a simulation makes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scan.hpp"

namespace kidnapwatch::core {

/// One scan and, where somebody worked it out afterwards, where the robot really was.
struct RecordedScan {
  Scan scan;
  std::optional<Pose> true_pose;  ///< T_map_base
};

struct Recording {
  std::string name;
  std::vector<RecordedScan> scans;  ///< in order of stamps
};

}  // namespace kidnapwatch::core
