// SPDX-License-Identifier: Apache-2.0
// Natural pairs and kidnappings of recorded runs, scored.
#include "core/study/recorded.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace kidnapwatch::core::study {
namespace {

constexpr std::size_t kTriesPerKidnapping = 50;

std::optional<Pose> position(const Recording& recording, std::size_t scan) {
  const RecordedScan& recorded = recording.scans[scan];
  return recording.scans.front().true_pose ? recorded.true_pose : recorded.scan.odometry;
}

bool far_apart(const Recording& recording, std::size_t here, std::size_t there, double least_m) {
  const auto a = position(recording, here);
  const auto b = position(recording, there);
  return a && b && distance_m(*a, *b) >= least_m;
}

/// A row of scores; nothing if one of them is missing or not finite.
std::optional<std::vector<double>> row(const Detectors& detectors, const Scan& scan) {
  std::vector<double> scores;
  bool complete = true;
  for (const auto& [id, detector] : detectors) {
    const auto score = detector->observe(scan);  // of every detector: they remember the scan
    complete = complete && score && std::isfinite(*score);
    scores.push_back(score.value_or(0.0));
  }
  return complete ? std::optional(std::move(scores)) : std::nullopt;
}

/// Taken away after `here`, to `there`.
std::optional<std::vector<double>> kidnapping(const Recording& recording, std::size_t here,
                                              std::size_t there, const Detectors& detectors) {
  const auto& scans = recording.scans;
  row(detectors, scans[here].scan);
  Scan after = scans[there].scan;
  after.stamp = scans[here + 1].scan.stamp;
  after.odometry = scans[here + 1].scan.odometry;
  return row(detectors, after);
}

}  // namespace

RecordedScores recorded_scores(const Recording& recording, const std::function<Detectors()>& make,
                               const RecordedConfig& config) {
  RecordedScores result{recording.name, {}, {}, {}, {}};
  const Detectors detectors = make();
  for (const auto& [id, detector] : detectors) {
    result.ids.push_back(id);
    result.polarities.push_back(detector->polarity());
  }
  const auto& scans = recording.scans;
  for (const RecordedScan& recorded : scans) {
    if (auto scores = row(detectors, recorded.scan)) result.natural.push_back(std::move(*scores));
  }
  std::mt19937_64 random(config.seed);
  for (std::size_t i = 0; i < kTriesPerKidnapping * config.kidnappings && scans.size() > 1; ++i) {
    if (result.kidnapped.size() == config.kidnappings) break;
    const std::size_t here = random() % (scans.size() - 1);
    const std::size_t there = random() % scans.size();
    if (!far_apart(recording, here, there, config.least_distance_m)) continue;
    auto scores = kidnapping(recording, here, there, make());
    if (scores) result.kidnapped.push_back(std::move(*scores));
  }
  return result;
}

}  // namespace kidnapwatch::core::study
