// SPDX-License-Identifier: Apache-2.0
// Pieces of recordings, told anew.
#include "core/evaluation/episode.hpp"

#include <cmath>
#include <numbers>

namespace kidnapwatch::core::evaluation {

double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1.0p-53;
}

std::size_t pick(Random& random, std::size_t size) { return random() % size; }

double gaussian(Random& random, double sd) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(random, 0.0, 1.0)));
  return sd * radius * std::cos(uniform(random, 0.0, 2.0 * std::numbers::pi));
}

std::optional<Pose> pose_of(const RecordedScan& recorded) {
  return recorded.true_pose ? recorded.true_pose : recorded.scan.odometry;
}

Pose told_motion(const Recording& recording, std::size_t from, std::size_t to) {
  const auto& before = recording.scans[from].scan.odometry;
  const auto& now = recording.scans[to].scan.odometry;
  return before && now ? inverse(*before) * *now : Pose{};
}

std::optional<Episode> relocated(const Recording& recording, std::size_t at, std::size_t from,
                                 std::size_t count, const Pose& first) {
  const auto& scans = recording.scans;
  if (at == 0 || at >= scans.size() || from == 0 || from + count > scans.size())
    return std::nullopt;
  const Scan& last = scans[at - 1].scan;
  Episode episode{at, {}};
  Stamp stamp = scans[at].scan.stamp;
  std::optional<Pose> odometry = last.odometry;
  if (odometry) odometry = *odometry * first;
  for (std::size_t i = from; i < from + count; ++i) {
    if (i > from) {
      stamp += scans[i].scan.stamp - scans[i - 1].scan.stamp;
      if (odometry) odometry = *odometry * told_motion(recording, i - 1, i);
    }
    episode.scans.push_back(scans[i].scan);
    episode.scans.back().stamp = stamp;
    episode.scans.back().odometry = odometry;
  }
  return episode;
}

std::optional<Episode> excerpt(const Recording& recording, std::size_t at, std::size_t from,
                               std::size_t count) {
  if (at == 0 || from < at || from + count > recording.scans.size()) return std::nullopt;
  Episode episode{at, {}};
  for (std::size_t i = from; i < from + count; ++i)
    episode.scans.push_back(recording.scans[i].scan);
  return episode;
}

}  // namespace kidnapwatch::core::evaluation
