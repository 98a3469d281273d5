// SPDX-License-Identifier: Apache-2.0
// A robot's scores, read: out of its blocks and the recent ones in memory.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/session.hpp"
#include "storage/recent.hpp"
#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// The robot's scores of from <= stamp < to, oldest first, at most `limit`.
[[nodiscard]] std::vector<core::Score> scores(Database& database, const RecentScores& recent,
                                              const std::string& robot, core::Stamp from,
                                              core::Stamp to, std::size_t limit);

/// Calls `take` with those of them that are in blocks, in any order.
void for_packed_scores(Database& database, const std::string& robot, core::Stamp from,
                       core::Stamp to, const std::function<void(const core::Score&)>& take);

/// Where the robot stood, with its last `natural_scores` natural scores; nothing if it has none.
[[nodiscard]] std::optional<RobotHistory> history(Database& database, const RecentScores& recent,
                                                  const std::string& robot,
                                                  std::size_t natural_scores);

}  // namespace kidnapwatch::storage
