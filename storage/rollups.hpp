// SPDX-License-Identifier: Apache-2.0
// Scores on their way into rollups: minutes first, hours made of them.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "storage/recent.hpp"
#include "storage/rollup.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Of a robot: what of its packed scores is in no rollup of a level.
struct OpenRollups {
  Segment segment = std::numeric_limits<Segment>::min();  ///< the last one that was packed
  std::vector<core::ScoreBucket> minutes;                 ///< within one span
  std::vector<core::ScoreBucket> hours;                   ///< within one span, without `minutes`
};

/// By the robot's number. Throws StorageError.
[[nodiscard]] OpenRollups open_rollups(Database& database, std::int64_t robot);

/// One thread. Throws StorageError.
///
/// Of each robot the minutes of a quarter of an hour and the hours of a day are open: they are
/// replaced with every segment, and become rows, never to be changed again, once the robot's scores
/// are of another one. Late scores make rows of their own, for what is read is added up.
class Rollups {
 public:
  explicit Rollups(Database& database);

  /// The scores of a robot that are packed; there are some. Within the same transaction.
  void add(std::int64_t robot, Segment segment, std::span<const ArrivedScore> scores);

 private:
  void write(std::int64_t robot, const RollupLevel& level, core::Stamp arrival,
             std::span<const core::ScoreBucket> run);

  Database& database_;
  Statement add_rollup_;
  Statement put_open_;
};

}  // namespace kidnapwatch::storage
