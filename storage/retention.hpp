// SPDX-License-Identifier: Apache-2.0
// What becomes too old or too much is deleted, a little at a time.
#pragma once

#include <chrono>
#include <cstdint>

#include "core/stamp.hpp"
#include "storage/rollup.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

struct RetentionConfig {
  std::chrono::hours keep_scores{30 * 24};      ///< longer within 10 s of an incident's evidence
  std::chrono::hours keep_minutes{60 * 24};     ///< not less than scores
  std::chrono::hours keep_hours{730 * 24};      ///< not less than minutes
  std::chrono::hours keep_incidents{365 * 24};  ///< with their evidence, once resolved
  /// Of the file. From 7/8 of it on the oldest scores go; when there are none, minutes; then scores
  /// about evidence, then hours. Incidents stay.
  std::uint64_t max_bytes = 8'000'000'000;
};

/// One thread. Throws StorageError.
///
/// What is finer never outlives what is coarser, or it would not be found: see score_buckets().
class Retention {
 public:
  /// The file will not grow beyond max_bytes: writing then fails as on a full disk.
  Retention(Database& database, RetentionConfig config);

  /// There may be something to delete. Age counts from `now`, the latest time of arrival.
  void begin(core::Stamp now);
  [[nodiscard]] bool is_cleaning() const { return is_cleaning_; }
  /// Deletes a few milliseconds' worth, within a transaction.
  void clean_some();
  void undone() { kept_until_ = core::Stamp::min(); }  ///< the transaction was

 private:
  [[nodiscard]] bool delete_old();
  [[nodiscard]] bool delete_old_incidents();
  [[nodiscard]] bool delete_surplus();
  /// Some that arrived before `until`.
  [[nodiscard]] bool delete_blocks(core::Stamp until);  // unless they are evidence
  [[nodiscard]] bool delete_any_blocks(core::Stamp until);
  [[nodiscard]] bool delete_rollups(const RollupLevel& level, core::Stamp until);
  [[nodiscard]] bool give_back_pages();
  [[nodiscard]] std::int64_t pages();
  [[nodiscard]] std::int64_t free_pages();

  Database& database_;
  const RetentionConfig config_;
  const std::int64_t max_pages_;
  Statement delete_blocks_;
  Statement delete_any_blocks_;
  Statement delete_rollups_;
  Statement delete_old_incidents_;
  bool is_cleaning_ = false;
  core::Stamp now_{};
  core::Stamp kept_until_ = core::Stamp::min();  // older blocks were deleted or are evidence
};

}  // namespace kidnapwatch::storage
