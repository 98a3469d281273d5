// SPDX-License-Identifier: Apache-2.0
// What is written but scores: incidents with all that belongs to them, and configurations.
#pragma once

#include <span>
#include <string>

#include "storage/audit.hpp"
#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Rows are durable when the transaction around them was committed. Throws StorageError. One
/// thread.
class Journal {
 public:
  explicit Journal(Database& database);

  void put(const IncidentChange& change);
  /// Replaces what was learned of the robot before.
  void put_learned(const std::string& robot, std::span<const float> numbers);
  void add(const ConfigText& config);
  void add(const AuditEntry& entry) { audit_.append(entry); }
  void add(const Gap& gap);
  /// The message was delivered.
  void confirm(const std::string& event_id);

 private:
  void add_evidence(const std::string& incident_id, const core::ScanPair& scans);

  Database& database_;
  Statement put_incident_;
  Statement add_scan_;
  Statement add_config_;
  Statement add_alert_;
  Statement add_gap_;
  Statement put_learned_;
  Statement confirm_;
  AuditTrail audit_;
};

}  // namespace kidnapwatch::storage
