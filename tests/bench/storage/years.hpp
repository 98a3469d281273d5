// SPDX-License-Identifier: Apache-2.0
// History beyond the scores: what a year takes, and how fast it is read.
#pragma once

#include <filesystem>

namespace kidnapwatch::storage {

/// Copies the day of rollups that is in the store to 60 days of minutes and a year of hours before
/// it, of all robots among each other; prints bytes, and what a fleet would take.
void add_years(const std::filesystem::path& file, int robots);

/// Prints how long it takes to read days, months and a year of a robot.
void read_years(const std::filesystem::path& file, int robots);

}  // namespace kidnapwatch::storage
