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

#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Reads beside one Writer. Every function may be called from any thread, is one consistent read
/// and throws StorageError.
class Archive {
 public:
  /// The file was prepared (by a Writer, or prepare_store).
  explicit Archive(std::filesystem::path file);
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// The robot's scores of from <= stamp < to, oldest first, at most `limit`.
  [[nodiscard]] std::vector<core::Score> scores(const std::string& robot, core::Stamp from,
                                                core::Stamp to, std::size_t limit) const;

  /// Newest first: their ids are UUIDv7, so in the order of ids.
  [[nodiscard]] std::vector<core::Incident> incidents(const IncidentFilter& filter) const;
  /// Open or acknowledged, newest first.
  [[nodiscard]] std::vector<core::Incident> unresolved_incidents() const;
  [[nodiscard]] std::optional<core::Incident> incident(const std::string& id) const;
  /// With the scores within 10 s of the two scans.
  [[nodiscard]] std::optional<core::Evidence> evidence(const std::string& incident_id) const;

  /// The latest; nothing before the first was set.
  [[nodiscard]] std::optional<ConfigText> config() const;
  /// Newest first.
  [[nodiscard]] std::vector<ConfigText> configs() const;

  /// Every robot that has a score, by id, with its last `natural_scores` natural scores.
  [[nodiscard]] std::vector<RobotHistory> robots(std::size_t natural_scores) const;

 private:
  class Lease;

  std::filesystem::path file_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Database>> idle_;  // connections
};

}  // namespace kidnapwatch::storage
