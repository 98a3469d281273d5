// SPDX-License-Identifier: Apache-2.0
// What becomes too old or too much is deleted, a little at a time.
#pragma once

#include <chrono>
#include <cstdint>

#include "core/stamp.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

struct RetentionConfig {
  std::chrono::hours keep_scores{30 * 24};      ///< longer within 10 s of an incident's evidence
  std::chrono::hours keep_incidents{365 * 24};  ///< with their evidence, once resolved
  std::uint64_t max_bytes = 8'000'000'000;  ///< of the file; the oldest scores go from 7/8 of it on
};

/// One thread. Throws StorageError.
class Retention {
 public:
  /// The file will not grow beyond max_bytes: writing then fails as on a full disk.
  Retention(Database& database, RetentionConfig config);

  /// There may be something to delete. Age counts from `now`, the latest time of arrival.
  void begin(core::Stamp now);
  [[nodiscard]] bool is_cleaning() const { return is_cleaning_; }
  /// Deletes a few milliseconds' worth, within a transaction.
  void clean_some();

 private:
  [[nodiscard]] bool delete_old_blocks();
  [[nodiscard]] bool delete_old_incidents();
  [[nodiscard]] bool delete_surplus_blocks();
  [[nodiscard]] bool give_back_pages();
  [[nodiscard]] std::int64_t pages();
  [[nodiscard]] std::int64_t free_pages();

  Database& database_;
  const RetentionConfig config_;
  const std::int64_t max_pages_;
  Statement delete_old_blocks_;
  Statement delete_old_incidents_;
  Statement delete_oldest_blocks_;
  bool is_cleaning_ = false;
  core::Stamp now_{};
  core::Stamp kept_until_ = core::Stamp::min();  // older blocks were deleted or are evidence
};

}  // namespace kidnapwatch::storage
