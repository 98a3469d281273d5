// SPDX-License-Identifier: Apache-2.0
// Least, most and the sum in fixed point.
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
  if (value && !std::isnan(*value)) lowest = std::min(lowest.value_or(*value), *value);
}

void keep_gravest(ScoreBucket& bucket, RobotState state) {
  if (bucket.scores == 0 || gravity(state) > gravity(bucket.state)) bucket.state = state;
}

constexpr int kFractionBits = 40;
constexpr float kMaxInSum = 0x1p50F;

Int128 fixed(float value) {
  const double part = std::clamp(value, -kMaxInSum, kMaxInSum);
  return static_cast<Int128>(std::nearbyint(std::ldexp(part, kFractionBits)));
}

}  // namespace

void Spread::add(double value) {
  const auto kept = static_cast<float>(value);
  if (!std::isfinite(kept)) return;
  add(Spread{.min = kept, .max = kept, .count = 1, .sum = fixed(kept)});
}

void Spread::add(const Spread& other) {
  if (other.count == 0) return;
  min = count == 0 ? other.min : std::min(min, other.min);
  max = count == 0 ? other.max : std::max(max, other.max);
  count += other.count;
  sum += other.sum;
}

double Spread::mean() const {
  return std::ldexp(static_cast<double>(sum), -kFractionBits) / static_cast<double>(count);
}

Stamp ScoreBucket::end() const { return from > Stamp::max() - width ? Stamp::max() : from + width; }

void ScoreBucket::add(const Score& score) {
  keep_gravest(*this, score.state);
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
}

void ScoreBucket::add(const ScoreBucket& other) {
  if (other.scores == 0) return;
  keep_gravest(*this, other.state);
  scores += other.scores;
  cost.add(other.cost);
  cost_per_beam.add(other.cost_per_beam);
  motion.add(other.motion);
  confirmed.add(other.confirmed);
  carry.add(other.carry);
  keep_lowest(threshold, other.threshold);
  keep_lowest(motion_threshold, other.motion_threshold);
}

Stamp begin_of(std::chrono::seconds width, Stamp stamp) {
  auto rest = stamp.time_since_epoch() % width;
  if (rest < rest.zero()) rest += width;  // before 1970
  return stamp < Stamp::min() + rest ? Stamp::min() : stamp - rest;
}

void ScoreBuckets::add(const Score& score) { add(score, score.stamp, resolution_); }

void ScoreBuckets::add(const ScoreBucket& bucket) {
  add(bucket, bucket.from, std::max(resolution_, bucket.width));
}

template <typename Part>
void ScoreBuckets::add(const Part& part, Stamp stamp, std::chrono::seconds width) {
  if (is_complete(begin_of(width, stamp))) return;
  bucket_of(stamp, width).add(part);
  if (buckets_.size() > limit_) {
    const auto last = std::prev(buckets_.end());
    end_ = last->first;
    buckets_.erase(last);
    latest_ = buckets_.end();
  }
}

ScoreBucket& ScoreBuckets::bucket_of(Stamp stamp, std::chrono::seconds width) {
  if (latest_ != buckets_.end() && latest_->second.holds(stamp)) return latest_->second;
  latest_ = buckets_.upper_bound(stamp);
  if (latest_ != buckets_.begin() && std::prev(latest_)->second.holds(stamp)) {
    --latest_;
  } else {
    const Stamp from = begin_of(width, stamp);
    latest_ = buckets_.try_emplace(from, ScoreBucket{.from = from, .width = width}).first;
  }
  return latest_->second;
}

std::vector<ScoreBucket> ScoreBuckets::all() const {
  std::vector<ScoreBucket> all;
  for (const auto& [from, bucket] : buckets_) all.push_back(bucket);
  return all;
}

}  // namespace kidnapwatch::core
