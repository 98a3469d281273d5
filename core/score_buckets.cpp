// SPDX-License-Identifier: Apache-2.0
// Running least, most and mean.
#include "core/score_buckets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace kidnapwatch::core {
namespace {

/// How grave each RobotState is.
constexpr std::array<int, 6> kGravity{1, 0, 4, 5, 2, 3};

int gravity(RobotState state) { return kGravity.at(static_cast<std::size_t>(state)); }

void keep_lowest(std::optional<double>& lowest, const std::optional<double>& value) {
  if (value) lowest = std::min(lowest.value_or(*value), *value);
}

}  // namespace

void Spread::add(double value) {
  if (!std::isfinite(value)) return;
  min = count == 0 ? value : std::min(min, value);
  max = count == 0 ? value : std::max(max, value);
  ++count;
  mean += (value - mean) / static_cast<double>(count);
}

void ScoreBucket::add(const Score& score) {
  ++scores;
  cost.add(score.dissimilarity.cost);
  cost_per_beam.add(score.dissimilarity.cost_per_beam);
  keep_lowest(threshold, score.threshold);
  if (const auto& of_motion = score.motion) {
    motion.add(of_motion->score);
    if (of_motion->confirmed) confirmed.add(*of_motion->confirmed);
    carry.add(of_motion->carry);
    keep_lowest(motion_threshold, of_motion->threshold);
  }
  if (scores == 1 || gravity(score.state) > gravity(state)) state = score.state;
}

Stamp ScoreBuckets::start(Stamp stamp) const {
  const auto since = stamp.time_since_epoch();
  auto rest = since % resolution_;
  if (rest < rest.zero()) rest += resolution_;  // before 1970
  return stamp - rest;
}

void ScoreBuckets::add(const Score& score) {
  const Stamp from = start(score.stamp);
  if (is_complete(from)) return;
  if (latest_ == buckets_.end() || latest_->first != from) {
    latest_ = buckets_.try_emplace(from, ScoreBucket{.from = from}).first;
  }
  latest_->second.add(score);
  if (buckets_.size() > limit_) {
    const auto last = std::prev(buckets_.end());
    end_ = last->first;
    buckets_.erase(last);
    latest_ = buckets_.end();
  }
}

std::vector<ScoreBucket> ScoreBuckets::all() const {
  std::vector<ScoreBucket> all;
  for (const auto& [from, bucket] : buckets_) all.push_back(bucket);
  return all;
}

}  // namespace kidnapwatch::core
