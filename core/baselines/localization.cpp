// SPDX-License-Identifier: Apache-2.0
// Runs filters along runs, and sums up their errors.
#include "core/baselines/localization.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kidnapwatch::core::baselines {
namespace {

/// The value that `share` of all are below; of an even number the upper one.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

Localization localized(std::span<const RecordedScan> scans, Mcl filter,
                       const std::optional<Pose>& start) {
  Localization updates;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan& scan = scans[i].scan;
    if (i == 0 && start) filter.start_at(*start);
    if (i == 0 && !start) filter.start_anywhere(scan);
    const Pose moved = i == 0 ? Pose{} : motion_between(scans[i - 1].scan, scan);
    updates.push_back(filter.update(scan, moved, scans[i].true_pose));
  }
  return updates;
}

std::optional<LocalizationErrors> errors(const Localization& localization,
                                         std::span<const RecordedScan> scans) {
  assert(localization.size() == scans.size());
  std::vector<double> off_m;
  std::vector<double> off_rad;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!localization[i] || !scans[i].true_pose) continue;
    const Pose off = inverse(*scans[i].true_pose) * localization[i]->T_map_base;
    off_m.push_back(std::hypot(off.x_m, off.y_m));
    off_rad.push_back(std::abs(off.theta_rad));
  }
  if (off_m.empty()) return std::nullopt;
  return LocalizationErrors{off_m.size(),          quantile(off_m, 0.5),
                            quantile(off_m, 0.95), std::ranges::max(off_m),
                            off_m.back(),          quantile(off_rad, 0.5)};
}

double median_max_current_weight(const Localization& localization) {
  std::vector<double> weights;
  for (const auto& update : localization) {
    if (update) weights.push_back(update->max_current_weight);
  }
  return quantile(weights, 0.5);
}

}  // namespace kidnapwatch::core::baselines
