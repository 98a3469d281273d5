// SPDX-License-Identifier: Apache-2.0
// Runs of which somebody said, scan by scan, whether the robot was lost: scores, without scans.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace kidnapwatch::adapters::logs {

struct LabelledRow {
  bool lost = false;
  std::vector<double> scores;  ///< finite; one per name
};

struct LabelledScores {
  std::vector<std::string> names;
  std::vector<LabelledRow> rows;  ///< in order of time
  std::size_t skipped_lines = 0;  ///< broken, or with a score that is not finite
};

/// Reads a CSV table as rostopic writes it, gzipped or not: of its columns `field.label` (0 or 1)
/// and those after it, whose names lose their "field.". The RobotLocalizationLossDataset of Milvus
/// Robotics is of this form. Throws BadInput naming the file if it is no such table or has no row.
[[nodiscard]] LabelledScores read_labelled_scores(const std::filesystem::path& file);

}  // namespace kidnapwatch::adapters::logs
