// SPDX-License-Identifier: Apache-2.0
// Trials counted up: per log and over all of them.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/evaluation/rates.hpp"
#include "core/evaluation/roc.hpp"
#include "core/evaluation/trial.hpp"

namespace kidnapwatch::core::evaluation {

/// All detectors on one recorded run.
struct LogTrial {
  std::string log;
  std::map<DetectorKind, TrialResult> results;
};

/// Share found at the threshold that a share `fpr` of the natural pairs exceeds.
struct OperatingPoint {
  double fpr = 0.0;
  double threshold = 0.0;
  Rate natural;  ///< what exceeds it: 0 of n where n < 1 / fpr
  Rate found;
};

enum class Family : std::uint8_t { natural, kidnap, confounder };

/// One detector, one kind of event, one log or all of them.
struct Row {
  DetectorKind detector{};
  Family family{};
  std::string kind;                 ///< "natural", "carry_natural" or the event's name
  std::string log;                  ///< or "pooled"
  Rate alarms;                      ///< at the robot's own threshold, learned from the first half
  std::optional<double> threshold;  ///< that one; none in "pooled"
  std::optional<Roc> roc;  ///< of kidnappings against natural pairs; points in "pooled" alone
  std::vector<OperatingPoint> points;         ///< of kidnappings
  std::map<std::string, std::size_t> causes;  ///< of the alarms
};

/// In order of detectors, logs ("pooled" last) and kinds. A log whose detector never had a
/// threshold is not pooled.
[[nodiscard]] std::vector<Row> rows(std::span<const LogTrial> trials);

[[nodiscard]] std::string_view name(Family family);

}  // namespace kidnapwatch::core::evaluation
