// SPDX-License-Identifier: Apache-2.0
// Interpolation of odometry in time.
#include "core/odometry_track.hpp"

#include <algorithm>

namespace kidnapwatch::core {
namespace {

constexpr double kKeep_s = 5.0;
constexpr std::size_t kMost = 1024;  // however fast they come
constexpr double kClockSetBack_s = 1.0;

/// `share` of the motion from `a` to `b` after `a`; beyond 1 it goes on.
Pose between(const Pose& a, const Pose& b, double share) {
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          wrapped(a.theta_rad + share * wrapped(b.theta_rad - a.theta_rad))};
}

}  // namespace

void OdometryTrack::add(Stamp stamp, const Pose& pose) {
  if (!entries_.empty() && stamp <= entries_.back().stamp) {
    if (elapsed_s(stamp, entries_.back().stamp) < kClockSetBack_s) return;
    entries_.clear();
  }
  entries_.push_back({stamp, pose});
  while (entries_.size() > kMost || elapsed_s(entries_.front().stamp, stamp) > kKeep_s)
    entries_.pop_front();
}

std::optional<Pose> OdometryTrack::at(Stamp stamp) const {
  const auto later = std::ranges::lower_bound(entries_, stamp, {}, &Entry::stamp);
  if (later != entries_.end() && later->stamp == stamp) return later->pose;
  if (later == entries_.begin()) return std::nullopt;  // older than all, or nothing known
  const bool ahead = later == entries_.end();
  const auto& last = entries_.back();
  if (ahead && elapsed_s(last.stamp, stamp) > kAhead_s) return std::nullopt;
  if (ahead && entries_.size() < 2) return last.pose;
  const auto b = ahead ? later - 1 : later;
  const auto a = b - 1;
  const double gap_s = elapsed_s(a->stamp, b->stamp);
  if (gap_s > kGapMax_s) return ahead ? std::optional(last.pose) : std::nullopt;
  return between(a->pose, b->pose, elapsed_s(a->stamp, stamp) / gap_s);
}

}  // namespace kidnapwatch::core
