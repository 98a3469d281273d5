// SPDX-License-Identifier: Apache-2.0
// Stamps that only ever go forward, from clocks that did not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/recording.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::adapters::logs {

/// Strictly increasing stamps for the times of a log's scans, in seconds since 1970 or, as many
/// logs have it, since a start of their own. A step is believed if it goes forward by at least 1 us
/// and at most a day; one that is not becomes the median of those believed, and all later stamps
/// move with it. Where less than half of the steps are believed the clock said nothing, and scans
/// are 1 s apart. A first time before 1970 or after 2100 becomes 1970. Throws BadInput where this
/// ends after 2250.
[[nodiscard]] std::vector<core::Stamp> increasing_stamps(std::span<const double> logged_s,
                                                         const std::string& where);

/// Stamps the scans with increasing_stamps. As many times as scans.
void set_stamps(core::Recording& recording, std::span<const double> logged_s,
                const std::string& where);

}  // namespace kidnapwatch::adapters::logs
