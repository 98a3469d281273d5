// SPDX-License-Identifier: Apache-2.0
// Natural pairs and kidnappings of recorded runs, scored.
#include "core/study/recorded.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include "core/baselines/mapping.hpp"
#include "core/baselines/mcl.hpp"

namespace kidnapwatch::core::study {
namespace {

constexpr std::size_t kTriesPerKidnapping = 50;

/// The robot is taken away after the scan `here`, to where the scan `there` was.
struct Kidnapping {
  std::size_t here;
  std::size_t there;
};

using Row = std::optional<std::vector<double>>;  // nothing if a score is missing or not finite

std::optional<Pose> position(const Recording& recording, std::size_t scan) {
  const RecordedScan& recorded = recording.scans[scan];
  return recording.scans.front().true_pose ? recorded.true_pose : recorded.scan.odometry;
}

bool is_usable(const Recording& recording, const Kidnapping& one, double least_m) {
  const auto& scans = recording.scans;
  const auto a = position(recording, one.here);
  const auto b = position(recording, one.there);
  return a && b && distance_m(*a, *b) >= least_m && is_comparable(scans[one.here].scan) &&
         is_comparable(scans[one.there].scan);
}

std::vector<Kidnapping> drawn(const Recording& recording, const RecordedConfig& config) {
  std::vector<Kidnapping> kidnappings;
  const std::size_t scans = recording.scans.size();
  std::mt19937_64 random(config.seed);
  for (std::size_t i = 0; i < kTriesPerKidnapping * config.kidnappings && scans > 1; ++i) {
    if (kidnappings.size() == config.kidnappings) break;
    const std::size_t here = random() % (scans - 1);
    const Kidnapping one{.here = here, .there = random() % scans};
    if (is_usable(recording, one, config.least_distance_m)) kidnappings.push_back(one);
  }
  return kidnappings;
}

Row row(const Detectors& detectors, const Scan& scan) {
  std::vector<double> scores;
  bool complete = true;
  for (const auto& [id, detector] : detectors) {
    const auto score = detector->observe(scan);  // of every detector: they remember the scan
    complete = complete && score && std::isfinite(*score);
    scores.push_back(score.value_or(0.0));
  }
  return complete ? Row(std::move(scores)) : std::nullopt;
}

Row kidnapped_row(const Recording& recording, const Kidnapping& kidnapping,
                  const Detectors& detectors) {
  const auto& scans = recording.scans;
  row(detectors, scans[kidnapping.here].scan);
  Scan after = scans[kidnapping.there].scan;
  after.stamp = scans[kidnapping.here + 1].scan.stamp;
  after.odometry = scans[kidnapping.here + 1].scan.odometry;
  return row(detectors, after);
}

/// By scan, and by kidnapping.
struct Rows {
  std::vector<Row> natural;
  std::vector<Row> kidnapped;
};

/// Of the detectors that compare two scans.
Rows pairwise_rows(const Recording& recording, const std::vector<Kidnapping>& kidnappings,
                   const Detectors& along_the_run, const std::function<Detectors()>& make) {
  Rows rows;
  for (const auto& recorded : recording.scans) {
    rows.natural.push_back(row(along_the_run, recorded.scan));
  }
  for (const Kidnapping& one : kidnappings) {
    rows.kidnapped.push_back(kidnapped_row(recording, one, make()));
  }
  return rows;
}

/// T_before_now of each scan; none of the first.
std::vector<Pose> motions(const Recording& recording, const std::vector<Pose>& poses) {
  std::vector<Pose> moved(poses.size());
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto& before = recording.scans[i - 1].scan.odometry;
    const auto& now = recording.scans[i].scan.odometry;
    moved[i] = before && now ? inverse(*before) * *now : inverse(poses[i - 1]) * poses[i];
  }
  return moved;
}

Row row(const std::optional<baselines::MclUpdate>& update) {
  if (!update) return std::nullopt;
  return std::vector{update->max_current_weight, update->measurement_entropy};
}

/// Of a filter in the map of the run itself.
Rows filter_rows(const Recording& recording, const std::vector<Kidnapping>& kidnappings,
                 const RecordedConfig& config) {
  const auto& scans = recording.scans;
  Rows rows{std::vector<Row>(scans.size()), std::vector<Row>(kidnappings.size())};
  if (scans.empty()) return rows;
  const auto poses = baselines::poses_of(scans);
  const auto moved = motions(recording, poses);
  const baselines::MeasuredMap map(baselines::map_from(scans, poses), {});
  baselines::Mcl filter(
      map, {.particles = config.particles, .relocalization = baselines::Relocalization::perfect},
      config.seed);
  filter.start_at(poses.front());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    rows.natural[i] = row(filter.update(scans[i].scan, moved[i], poses[i]));
    for (std::size_t k = 0; k < kidnappings.size(); ++k) {
      if (kidnappings[k].here != i) continue;
      baselines::Mcl lost = filter;
      rows.kidnapped[k] = row(lost.update(scans[kidnappings[k].there].scan, moved[i + 1]));
    }
  }
  return rows;
}

/// The rows that are complete in both.
std::vector<std::vector<double>> joined(std::vector<Row> left, const std::vector<Row>& right) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i] || (!right.empty() && !right[i])) continue;
    if (!right.empty()) left[i]->insert(left[i]->end(), right[i]->begin(), right[i]->end());
    rows.push_back(std::move(*left[i]));
  }
  return rows;
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
  const auto kidnappings = drawn(recording, config);
  const Rows pairwise = pairwise_rows(recording, kidnappings, detectors, make);
  Rows filter;
  if (config.particles > 0) {
    result.ids.insert(result.ids.end(), {"mcw", "me"});
    result.polarities.insert(result.polarities.end(), {Polarity::lptf, config.me_polarity});
    filter = filter_rows(recording, kidnappings, config);
  }
  result.natural = joined(pairwise.natural, filter.natural);
  result.kidnapped = joined(pairwise.kidnapped, filter.kidnapped);
  return result;
}

}  // namespace kidnapwatch::core::study
