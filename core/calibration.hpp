// SPDX-License-Identifier: Apache-2.0
// A robot's own threshold, learned from its unlabelled driving.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>

namespace kidnapwatch::core {

struct CalibrationConfig {
  double false_alarm_rate = 1e-3;   ///< targeted share of natural pairs above the threshold
  std::size_t warmup_pairs = 100;   ///< scores to see before there is a threshold
  std::size_t window_pairs = 1000;  ///< most recent scores that count

  friend bool operator==(const CalibrationConfig&, const CalibrationConfig&) = default;
};

/// The value that a share `false_alarm_rate` (< 0.05) of scores exceeds, by an exponential tail
/// above their 95th percentile: q95 + (mean excess over q95) ln(0.05 / rate). At least 20 scores.
[[nodiscard]] double exponential_tail_threshold(std::span<const double> scores,
                                                double false_alarm_rate);

/// The last window_pairs natural scores of one robot, and the threshold they give.
class Calibration {
 public:
  explicit Calibration(const CalibrationConfig& config) : config_(config) {}

  /// Takes the score of a pair of scans believed to be natural: never one of an incident.
  void learn(double score);

  /// From now on; the scores are kept.
  void configure(const CalibrationConfig& config);

  /// Nothing before warmup_pairs scores were learned.
  [[nodiscard]] std::optional<double> threshold() const noexcept { return threshold_; }

  [[nodiscard]] std::size_t pairs() const noexcept { return scores_.size(); }

 private:
  void fit();

  CalibrationConfig config_;
  std::deque<double> scores_;
  std::optional<double> threshold_;
  std::size_t unseen_ = 0;  // learned since threshold_ was fitted
};

}  // namespace kidnapwatch::core
