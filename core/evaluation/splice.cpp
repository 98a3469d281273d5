// SPDX-License-Identifier: Apache-2.0
// Cutting recorded runs and sewing them together again.
#include "core/evaluation/splice.hpp"

#include <algorithm>
#include <iterator>

#include "core/bad_input.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

double seconds_in(const Recording& recording, std::size_t scan) {
  return elapsed_s(recording.scans.front().scan.stamp, recording.scans[scan].scan.stamp);
}

/// Index of the first scan at or after `at_s`; the number of scans if there is none.
std::size_t first_from(const Recording& recording, double at_s) {
  const auto later = std::ranges::find_if(recording.scans, [&](const RecordedScan& recorded) {
    return elapsed_s(recording.scans.front().scan.stamp, recorded.scan.stamp) >= at_s;
  });
  return static_cast<std::size_t>(later - recording.scans.begin());
}

/// The scans of `source` from `first` on, as they follow if `replaced` was to come next.
std::vector<RecordedScan> continued(const Recording& source, std::size_t first,
                                    const Scan& replaced) {
  const Scan& start = source.scans[first].scan;
  std::vector<RecordedScan> scans(source.scans.begin() + static_cast<std::ptrdiff_t>(first),
                                  source.scans.end());
  const auto shift = replaced.stamp - start.stamp;
  std::optional<Pose> T_new_old;
  if (replaced.odometry && start.odometry)
    T_new_old = *replaced.odometry * inverse(*start.odometry);
  for (RecordedScan& recorded : scans) {
    Scan& scan = recorded.scan;
    scan.stamp += shift;
    if (scan.odometry && T_new_old) {
      scan.odometry = *T_new_old * *scan.odometry;
    } else {
      scan.odometry.reset();
    }
  }
  return scans;
}

std::size_t scan_to_replace(const Recording& spliced, std::size_t earliest, double at_s) {
  const std::size_t scan = first_from(spliced, at_s);
  if (scan < earliest) throw BadInput("at_s", "no scan between the cut and what is before it");
  if (scan >= spliced.scans.size()) throw BadInput("at_s", "after the last scan");
  return scan;
}

std::size_t scan_to_go_to(const Recording& recording, double to_s) {
  const std::size_t scan = first_from(recording, to_s);
  if (to_s < 0.0) throw BadInput("to_s", "before the first scan");
  if (scan >= recording.scans.size()) throw BadInput("to_s", "after the last scan");
  return scan;
}

std::optional<Pose> position(const RecordedScan& recorded, bool by_true_pose) {
  return by_true_pose ? recorded.true_pose : recorded.scan.odometry;
}

}  // namespace

Spliced splice(const Recording& recording, std::span<const Cut> cuts) {
  Spliced spliced{recording, {}};
  std::size_t earliest = 1;
  for (const Cut& cut : cuts) {
    auto& scans = spliced.recording.scans;
    const std::size_t at = scan_to_replace(spliced.recording, earliest, cut.at_s);
    const std::size_t to = scan_to_go_to(recording, cut.to_s);
    const Scan replaced = scans[at].scan;
    scans.resize(at);
    std::ranges::move(continued(recording, to, replaced), std::back_inserter(scans));
    spliced.first_after.push_back(at);
    earliest = at + 1;
  }
  return spliced;
}

std::optional<Cut> far_jump(const Recording& recording, const FarJumpConfig& config) {
  const auto& scans = recording.scans;
  const std::size_t at = std::max(scans.size() / 2, config.scans_before);
  if (at >= scans.size()) return std::nullopt;
  const bool by_true_pose = scans[at].true_pose.has_value();
  const auto here = position(scans[at], by_true_pose);
  if (!here) return std::nullopt;
  std::optional<std::size_t> farthest;
  double farthest_m = config.min_distance_m;
  for (std::size_t to = 0; to + config.scans_after <= scans.size(); ++to) {
    const auto there = position(scans[to], by_true_pose);
    if (!there) continue;
    const double away_m = distance_m(*here, *there);
    if (farthest ? away_m <= farthest_m : away_m < farthest_m) continue;
    farthest = to;
    farthest_m = away_m;
  }
  if (!farthest) return std::nullopt;
  return Cut{seconds_in(recording, at), seconds_in(recording, *farthest)};
}

}  // namespace kidnapwatch::core::evaluation
