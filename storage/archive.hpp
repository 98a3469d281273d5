// SPDX-License-Identifier: Apache-2.0
// The store, read: history for people and for the next start of the service.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/score_buckets.hpp"
#include "storage/recent.hpp"
#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Reads beside one Writer. Every function may be called from any thread, is one consistent read
/// and throws StorageError.
class Archive {
 public:
  /// The file was prepared (by a Writer, or prepare_store). `recent` is that of the file's Writer;
  /// without it, as in another process, every read of scores looks through the hot tables.
  explicit Archive(std::filesystem::path file,
                   std::shared_ptr<const RecentScores> recent = nullptr);
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// The robot's scores of from <= stamp < to, oldest first, at most `limit`.
  [[nodiscard]] std::vector<core::Score> scores(const std::string& robot, core::Stamp from,
                                                core::Stamp to, std::size_t limit) const;

  /// The same scores in buckets, oldest first, at most `limit` of them, and scores that are gone;
  /// see storage/buckets.hpp.
  [[nodiscard]] std::vector<core::ScoreBucket> score_buckets(const std::string& robot,
                                                             core::Stamp from, core::Stamp to,
                                                             std::chrono::seconds resolution,
                                                             std::size_t limit) const;

  /// Newest first: their ids are UUIDv7, so in the order of ids.
  [[nodiscard]] std::vector<core::Incident> incidents(const IncidentFilter& filter) const;
  /// Open or acknowledged, newest first.
  [[nodiscard]] std::vector<core::Incident> unresolved_incidents() const;
  [[nodiscard]] std::optional<core::Incident> incident(const std::string& id) const;
  /// With the scores within 10 s of the two scans.
  [[nodiscard]] std::optional<core::Evidence> evidence(const std::string& incident_id) const;

  /// The latest of the fleet and of each robot that has one, oldest first.
  [[nodiscard]] std::vector<ConfigText> latest_configs() const;
  /// Newest first.
  [[nodiscard]] std::vector<ConfigText> configs(const ConfigFilter& filter) const;

  /// Alerts that were not delivered, and the latest of each unresolved incident, in the order in
  /// which they were written.
  [[nodiscard]] std::vector<OutboxMessage> outbox() const;

  /// In the order in which they were written, at most `limit`, only those after number `after`.
  [[nodiscard]] std::vector<StoredAlert> alerts(std::int64_t after, std::size_t limit) const;
  /// Of an incident, oldest first.
  [[nodiscard]] std::vector<StoredAlert> alerts_of(const std::string& incident_id) const;
  [[nodiscard]] AlertNumbers alert_numbers() const;

  /// Where scores are missing, oldest first.
  [[nodiscard]] std::vector<Gap> gaps() const;

  /// Newest first, at most `limit`, only those before entry `before` if given.
  [[nodiscard]] std::vector<NumberedAuditEntry> audit(std::optional<std::int64_t> before,
                                                      std::size_t limit) const;
  /// See first_broken_audit_entry.
  [[nodiscard]] std::optional<std::int64_t> broken_audit_entry() const;

  /// Every robot that has a score, by id, with its last `natural_scores` natural scores and what
  /// was learned.
  [[nodiscard]] std::vector<RobotHistory> robots(std::size_t natural_scores) const;

 private:
  class Lease;
  [[nodiscard]] std::shared_ptr<const RecentScores> recent(Database& database) const;

  std::filesystem::path file_;
  std::shared_ptr<const RecentScores> recent_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Database>> idle_;  // connections
};

}  // namespace kidnapwatch::storage
