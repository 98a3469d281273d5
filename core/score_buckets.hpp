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

__extension__ using Int128 = __int128;

/// Of the finite values among those added, each in single precision. Adding up is exact: in
/// whatever order and parts values are added, the outcome is the same.
struct Spread {
  float min = 0.0F;
  float max = 0.0F;
  std::size_t count = 0;  ///< 0: the others mean nothing
  Int128 sum = 0;         ///< in units of 2^-40; what is beyond 2^50 (1e15) counts as that

  void add(double value);
  void add(const Spread& other);
  [[nodiscard]] double mean() const;

  friend bool operator==(const Spread&, const Spread&) = default;
};

/// All scores of from <= stamp < from + width.
struct ScoreBucket {
  Stamp from;
  std::chrono::seconds width{1};
  std::size_t scores = 0;
  Spread cost;
  Spread cost_per_beam;
  Spread motion;  ///< MotionScore::score
  Spread confirmed;
  Spread carry;
  std::optional<double> threshold;         ///< the lowest
  std::optional<double> motion_threshold;  ///< the lowest
  RobotState state = RobotState::normal;   ///< the gravest: kidnapped before suspect before others

  [[nodiscard]] Stamp end() const;  ///< exclusive
  [[nodiscard]] bool holds(Stamp stamp) const { return stamp >= from && stamp < end(); }
  void add(const Score& score);
  /// All that was added to `other`, wherever that begins.
  void add(const ScoreBucket& other);

  friend bool operator==(const ScoreBucket&, const ScoreBucket&) = default;
};

/// The latest multiple of `width` (above 0) since 1970 that is not after `stamp`.
[[nodiscard]] Stamp begin_of(std::chrono::seconds width, Stamp stamp);

/// Takes scores in any order; keeps the first `limit` buckets that have any.
class ScoreBuckets {
 public:
  /// Buckets begin at multiples of `resolution` (above 0) since 1970.
  ScoreBuckets(std::chrono::seconds resolution, std::size_t limit)
      : resolution_(resolution), limit_(limit) {}

  ScoreBuckets(const ScoreBuckets&) = delete;
  ScoreBuckets& operator=(const ScoreBuckets&) = delete;

  void add(const Score& score);
  /// Scores that were summed up before. A bucket wider than the resolution stays as wide, and takes
  /// all scores of its time that are added after it. One width is a multiple of the other.
  void add(const ScoreBucket& bucket);
  /// Whether no score of `stamp` or later can count any more.
  [[nodiscard]] bool is_complete(Stamp stamp) const { return end_ && stamp >= *end_; }
  /// Oldest first.
  [[nodiscard]] std::vector<ScoreBucket> all() const;

 private:
  template <typename Part>
  void add(const Part& part, Stamp stamp, std::chrono::seconds width);
  [[nodiscard]] ScoreBucket& bucket_of(Stamp stamp, std::chrono::seconds width);

  std::chrono::seconds resolution_;
  std::size_t limit_;
  std::map<Stamp, ScoreBucket> buckets_;
  std::map<Stamp, ScoreBucket>::iterator latest_ = buckets_.end();  // that was added to
  std::optional<Stamp> end_;                                        // of what counts
};

}  // namespace kidnapwatch::core
