// SPDX-License-Identifier: Apache-2.0
// A threshold from the tail of what is normal.
#include "core/calibration.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace kidnapwatch::core {
namespace {

constexpr double kTail = 0.05;           // the share of scores that the tail is fitted to
constexpr std::size_t kRefitEvery = 20;  // scores; sorting the window for each one would be waste

}  // namespace

double exponential_tail_threshold(std::span<const double> scores, double false_alarm_rate) {
  assert(scores.size() >= 20 && false_alarm_rate > 0.0 && false_alarm_rate < kTail);
  std::vector<double> sorted(scores.begin(), scores.end());
  std::ranges::sort(sorted);
  const auto rank = static_cast<std::size_t>((1.0 - kTail) * static_cast<double>(sorted.size()));
  const double q95 = sorted[rank];
  double excess = 0.0;
  for (std::size_t i = rank; i < sorted.size(); ++i) {
    excess += sorted[i] - q95;
  }
  const auto above = static_cast<double>(std::max<std::size_t>(1, sorted.size() - rank - 1));
  const double rate = std::max(false_alarm_rate, std::numeric_limits<double>::min());
  return q95 + excess / above * std::log(kTail / rate);  // finite, whatever the rate
}

void Calibration::learn(double score) {
  scores_.push_back(score);
  if (scores_.size() > config_.window_pairs) {
    scores_.pop_front();
  }
  if (!threshold_ || ++unseen_ >= kRefitEvery) {
    fit();
  }
}

void Calibration::configure(const CalibrationConfig& config) {
  config_ = config;
  while (scores_.size() > config_.window_pairs) {
    scores_.pop_front();
  }
  threshold_.reset();
  fit();
}

void Calibration::fit() {
  if (scores_.size() >= config_.warmup_pairs) {
    const std::vector<double> seen(scores_.begin(), scores_.end());
    threshold_ = exponential_tail_threshold(seen, config_.false_alarm_rate);
    unseen_ = 0;
  }
}

}  // namespace kidnapwatch::core
