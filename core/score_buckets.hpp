// SPDX-License-Identifier: Apache-2.0
// Scores summed up by time, for who looks at a day or a year: no spike is lost between the means.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "core/session.hpp"

namespace kidnapwatch::core {

/// Of the finite values among those added.
struct Spread {
  double min = 0.0;
  double max = 0.0;
  double mean = 0.0;
  std::size_t count = 0;  ///< 0: the others mean nothing

  void add(double value);

  friend bool operator==(const Spread&, const Spread&) = default;
};

/// All scores of from <= stamp < from + resolution.
struct ScoreBucket {
  Stamp from;
  std::size_t scores = 0;
  Spread cost;
  Spread cost_per_beam;
  Spread motion;  ///< MotionScore::score
  Spread confirmed;
  Spread carry;
  std::optional<double> threshold;         ///< the lowest
  std::optional<double> motion_threshold;  ///< the lowest
  RobotState state = RobotState::normal;   ///< the gravest: kidnapped before suspect before others

  void add(const Score& score);

  friend bool operator==(const ScoreBucket&, const ScoreBucket&) = default;
};

/// Takes scores in any order; keeps the first `limit` buckets that have any.
class ScoreBuckets {
 public:
  /// Buckets begin at multiples of `resolution` (above 0) since 1970.
  ScoreBuckets(std::chrono::nanoseconds resolution, std::size_t limit)
      : resolution_(resolution), limit_(limit) {}

  ScoreBuckets(const ScoreBuckets&) = delete;
  ScoreBuckets& operator=(const ScoreBuckets&) = delete;

  void add(const Score& score);
  /// Whether no score of `stamp` or later can count any more.
  [[nodiscard]] bool is_complete(Stamp stamp) const { return end_ && stamp >= *end_; }
  /// Oldest first.
  [[nodiscard]] std::vector<ScoreBucket> all() const;

 private:
  [[nodiscard]] Stamp start(Stamp stamp) const;

  std::chrono::nanoseconds resolution_;
  std::size_t limit_;
  std::map<Stamp, ScoreBucket> buckets_;
  std::map<Stamp, ScoreBucket>::iterator latest_ = buckets_.end();  // that was added to
  std::optional<Stamp> end_;                                        // of what counts
};

}  // namespace kidnapwatch::core
