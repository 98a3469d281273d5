// SPDX-License-Identifier: Apache-2.0
// A robot's scores in buckets, read: out of hours, minutes, blocks and the recent ones in memory.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "core/score_buckets.hpp"
#include "storage/recent.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// The robot's scores of from <= stamp < to in buckets of nesting(resolution), oldest first, at
/// most `limit` of them; one consistent look. Each score that was ever stored is in exactly one,
/// as long as rollups are kept.
///
/// Where single scores are gone, or minutes, the buckets are as wide as what is left, and whole:
/// the first may begin before `from`, the last may end after `to`.
[[nodiscard]] std::vector<core::ScoreBucket> score_buckets(
    Database& database, const RecentScores& recent, const std::string& robot, core::Stamp from,
    core::Stamp to, std::chrono::seconds resolution, std::size_t limit);

}  // namespace kidnapwatch::storage
