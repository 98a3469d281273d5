// SPDX-License-Identifier: Apache-2.0
// Tunings of motion consistency to choose from, and the choice for robots that it must not see.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/evaluation/trial.hpp"
#include "core/motion_tuning.hpp"

namespace kidnapwatch::core::evaluation {

struct Candidate {
  std::string_view name;
  MotionTuning tuning;
};

/// What there is to choose from: what was shipped when the grid was laid out, then each constant
/// alone made smaller and greater.
[[nodiscard]] std::span<const Candidate> candidates();

/// A run with every candidate: what a choice for other robots is made from.
struct Rehearsal {
  std::string folder;                ///< stands for the robot and its sensor
  std::vector<TrialResult> results;  ///< one per candidate; none: the run cannot be used
};

struct Choice {
  std::size_t candidate = 0;
  double floor = 0.0;  ///< no robot's threshold is below: MotionConfig::threshold_min
  double worth = 0.0;  ///< see `chosen`
};

/// The best candidate by the runs of all folders but `folder`, whose results are not looked at.
///
/// At most a share `rate` of all their natural pairs exceeds a floor; floors are tried from there
/// in steps of 0.5 (only that of MotionConfig where there are fewer than 2 / rate). What a
/// candidate with a floor is worth is the mean share of kidnappings found, over the kinds, less
/// kAlarmCost times the mean share of confounders that alarm, over theirs. A candidate whose alarm
/// for slow carries is false more than kCarryRate per pair does not come into question. Equally
/// good ones: the first.
[[nodiscard]] Choice chosen(std::span<const Rehearsal> rehearsals, std::string_view folder,
                            double rate);

inline constexpr double kAlarmCost = 5.0;
inline constexpr double kCarryRate = 2e-4;

}  // namespace kidnapwatch::core::evaluation
