// SPDX-License-Identifier: Apache-2.0
// A filter along a whole run, and how far off it was.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/baselines/mcl.hpp"
#include "core/recording.hpp"

namespace kidnapwatch::core::baselines {

/// An update for each scan: nothing where it had no valid beam.
using Localization = std::vector<std::optional<MclUpdate>>;

/// The filter's updates along a run. At the first scan it is put to `start` or, without one,
/// anywhere.
[[nodiscard]] Localization localized(std::span<const RecordedScan> scans, Mcl filter,
                                     const std::optional<Pose>& start);

/// Estimates against true poses, over the scans that have both.
struct LocalizationErrors {
  std::size_t scans = 0;
  double median_m = 0.0;
  double q95_m = 0.0;
  double largest_m = 0.0;
  double last_m = 0.0;
  double median_rad = 0.0;
};

/// Nothing for a run without true poses.
[[nodiscard]] std::optional<LocalizationErrors> errors(const Localization& localization,
                                                       std::span<const RecordedScan> scans);

/// Of all updates; NaN if there is none.
[[nodiscard]] double median_max_current_weight(const Localization& localization);

}  // namespace kidnapwatch::core::baselines
