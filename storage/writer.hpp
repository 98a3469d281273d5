// SPDX-License-Identifier: Apache-2.0
// The one thread that writes the store: everything through one bounded queue, in group commits.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/durations.hpp"
#include "storage/records.hpp"
#include "storage/retention.hpp"
#include "storage/segments.hpp"

namespace kidnapwatch::storage {

struct WriterConfig {
  std::filesystem::path file;
  std::chrono::milliseconds commit_every{50};
  std::size_t max_queued = 100'000;           ///< scores
  std::size_t max_changes = 10'000;           ///< of incidents, and other records
  std::chrono::milliseconds retry_max{1000};  ///< longest wait between attempts at a failed commit
  SegmentConfig segments = {};
  RetentionConfig retention = {};
};

/// Durable once a commit returned (WAL, synchronous=FULL). Scores wait for the next group commit;
/// all else is committed at once. Old scores are packed and deleted along with the commits.
///
/// While the disk refuses (full, I/O error) the Writer is not healthy; it keeps what it has and
/// tries again with growing pauses, so that memory holds at most max_queued scores and max_changes
/// other records. Scores that were refused, or died with a writer, leave a Gap; changes of
/// incidents that were refused leave an entry in the audit trail with their number.
class Writer {
 public:
  /// Opens and migrates the file (prepare_store). Throws StorageError if that fails, or another
  /// Writer has the file.
  explicit Writer(const WriterConfig& config);
  /// Writes all that is queued, then stops; gives up at the first failure.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Kept as_stored(). False, and counted, if the queue is full. Never blocks. Any thread.
  bool add_score(const std::string& robot, const core::Score& score, core::Stamp arrival);
  /// Inserts or, by id, replaces unless the stored seq is higher; with its alert and an entry in
  /// the audit trail in the same transaction. While a thousand changes wait for a failing disk,
  /// more are kept without evidence; while max_changes wait, more are refused and counted. Never
  /// blocks. Any thread.
  void put_incident(IncidentChange change);
  /// Keeps numbers, whose meaning is the caller's, in place of those put before of the same robot,
  /// with the next group commit. Any thread.
  void put_learned(const std::string& robot, std::vector<float> numbers);
  /// The alert with this id has arrived; forgotten where put_incident() would refuse, for to
  /// deliver it again does no harm. Any thread.
  void confirm_delivery(std::string event_id);
  /// For what changes nothing else here, such as tokens; refused as by put_incident(). Any thread.
  void add_audit(AuditEntry entry);
  /// A new version of the configuration, as text; the future is ready when it is durable, and
  /// throws StorageError if it could not be written: then it never will be. Any thread.
  std::future<void> add_config(ConfigText config);
  /// Ready when all that was given before is durable; throws StorageError if the next attempt to
  /// write it fails. Any thread.
  std::future<void> flush();

  [[nodiscard]] std::uint64_t queued() const;     ///< scores not yet durable
  [[nodiscard]] std::uint64_t lost() const;       ///< scores, changes and entries refused
  [[nodiscard]] core::Durations commits() const;  ///< how long each took that succeeded
  [[nodiscard]] bool healthy() const;             ///< the last commit succeeded
  [[nodiscard]] std::string problem() const;      ///< why it did not; empty if healthy
  /// Where a damaged file was put aside when this Writer started, with a fresh one in its place.
  [[nodiscard]] const std::optional<std::filesystem::path>& quarantined() const;
  /// For an Archive beside this Writer.
  [[nodiscard]] std::shared_ptr<const RecentScores> recent() const;

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace kidnapwatch::storage
