// SPDX-License-Identifier: Apache-2.0
// Scores summed up by the minute and by the hour, in few bytes: what is kept for years.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "core/score_buckets.hpp"

namespace kidnapwatch::storage {

/// How scores are summed up: in buckets of `width`, stored by runs of at most a `span`.
struct RollupLevel {
  std::chrono::seconds width;
  std::chrono::seconds span;  ///< between multiples of it

  friend bool operator==(const RollupLevel&, const RollupLevel&) = default;
};
inline constexpr RollupLevel kMinutes{std::chrono::minutes(1), std::chrono::minutes(15)};
inline constexpr RollupLevel kHours{std::chrono::hours(1), std::chrono::hours(24)};

/// The least number of seconds from `resolution` (1 s to a day) on that divides a minute, divides
/// an hour in minutes, or is a number of hours: such buckets end where those above end.
[[nodiscard]] std::chrono::seconds nesting(std::chrono::seconds resolution);

/// As bytes. Oldest first, all of `level` and within a span of it.
[[nodiscard]] std::vector<std::byte> packed(std::span<const core::ScoreBucket> buckets,
                                            const RollupLevel& level);
/// The inverse. Throws StorageError if these are not bytes of packed().
[[nodiscard]] std::vector<core::ScoreBucket> unpacked(std::span<const std::byte> data,
                                                      const RollupLevel& level);

}  // namespace kidnapwatch::storage
