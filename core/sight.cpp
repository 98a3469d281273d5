// SPDX-License-Identifier: Apache-2.0
// Two scans, looked at once more.
#include "core/sight.hpp"

#include <utility>

#include "core/contour.hpp"
#include "core/free_space.hpp"
#include "core/motion_consistency.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::size_t kCellsMax = std::size_t{1} << 24U;  // 4096 beams each: 16 MB

std::optional<Warping> warping(const ScanPair& scans, const DissimilarityConfig& config) {
  Bearings bearings;
  Sample before;
  Sample after;
  prepare(scans.before, config, bearings, before);
  prepare(scans.after, config, bearings, after);
  if (before.size() > kCellsMax / after.size()) return std::nullopt;
  DissimilarityWorkspace workspace;
  const Gated warped = gated(before, after, config, workspace);
  Warping result{.standardized = warped.standardized, .steps = dtw_path(warped.before, warped.now)};
  const auto beams_before = kept_beams(scans.before, config.invalid);
  const auto beams_after = kept_beams(scans.after, config.invalid);
  for (auto& step : result.steps) {
    result.cost += step.cost;
    step.p = beams_before[step.p];
    step.q = beams_after[step.q];
  }
  return result;
}

std::optional<Pose> told(const ScanPair& scans, const Pose& sensor) {
  if (!scans.before.odometry || !scans.after.odometry) return std::nullopt;
  const Pose base = inverse(*scans.before.odometry) * *scans.after.odometry;
  return inverse(sensor) * base * sensor;
}

std::optional<MotionSight> motion(const ScanPair& scans, const MotionConfig& config) {
  Contour before;
  Contour after;
  trace(scans.before, before);
  trace(scans.after, after);
  const auto by_wheels = told(scans, config.sensor);
  const Pose claimed = by_wheels.value_or(Pose{});
  const Comparison seen =
      compare(before, after, {claimed, claimed, by_wheels.has_value(), {}}, config.tuning);
  if (!seen.judged) return std::nullopt;
  return MotionSight{.told = by_wheels,
                     .seen = seen.seen,
                     .violating_before = violating_beams(after, before, inverse(seen.seen)),
                     .violating_after = violating_beams(before, after, seen.seen)};
}

}  // namespace

Sight sight(const ScanPair& scans, const DetectionConfig& config) {
  if (!is_comparable(scans.before) || !is_comparable(scans.after)) return {};
  return {.warping = warping(scans, config.dissimilarity), .motion = motion(scans, config.motion)};
}

}  // namespace kidnapwatch::core
