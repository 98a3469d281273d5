// SPDX-License-Identifier: Apache-2.0
// Where scores go: appended to a hot table first, later packed into blocks of one robot each.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "storage/recent.hpp"
#include "storage/rollups.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

struct SegmentConfig {
  std::size_t scores_per_robot = 300;  ///< on average, when a segment is closed: a minute at 5 Hz
  std::size_t max_scores = 300'000;    ///< of all robots, when it is closed at the latest
  std::size_t robots_per_commit = 20;  ///< packed along with new rows: 3 ms
};

/// The robots, by the number that they have in the tables.
class RobotIds {
 public:
  explicit RobotIds(Database& database);

  /// Adds a new robot to the table. Within a transaction.
  [[nodiscard]] std::int64_t of(const std::string& robot);
  void forget() { known_.clear(); }  ///< the transaction was undone

 private:
  Database& database_;
  Statement find_;
  Statement add_;
  std::unordered_map<std::string, std::int64_t> known_;
};

/// Rows go to one of two hot tables, in turns. Once a table is full the segment is closed: it is
/// packed, a few robots per transaction, while the other table fills; then emptied at once. One
/// thread. Throws StorageError.
///
/// Appending writes a hundredth of what a table clustered by robot and time would, and one large
/// transaction for all robots would stop all writing for 235 ms.
class Segments {
 public:
  /// Reads the hot tables into memory.
  Segments(Database& database, SegmentConfig config);

  /// Appends the rows, and packs. To be called within a transaction; the rows live until after it.
  void write(std::span<const ScoreRow> rows);
  /// The transaction was committed: what it wrote becomes visible.
  void committed();
  void undone();  ///< or it was not

  /// Whether there is a closed segment to pack, even without new rows.
  [[nodiscard]] bool is_packing() const { return state_.packing; }
  [[nodiscard]] std::shared_ptr<const RecentScores> recent() const { return recent_; }

 private:
  struct State {
    Segment open = 0;        // that rows are appended to
    bool packing = false;    // the one before it still has its hot rows
    std::size_t packed = 0;  // of waiting_
  };

  [[nodiscard]] bool is_full() const;
  void close();
  void pack_some();
  void pack(const std::string& robot, Segment segment);

  const SegmentConfig config_;
  RobotIds robot_ids_;
  Rollups rollups_;
  std::array<Statement, 2> add_score_;
  std::array<Statement, 2> empty_;
  Statement add_block_;
  Statement set_open_;
  std::shared_ptr<RecentScores> recent_;
  std::vector<std::string> waiting_;  // robots of the closed segment without blocks
  std::span<const ScoreRow> rows_;    // of this transaction
  State state_;                       // as committed
  State next_;                        // once the transaction is
};

/// The durable rows of both hot tables.
[[nodiscard]] std::shared_ptr<RecentScores> hot_scores(Database& database);

}  // namespace kidnapwatch::storage
