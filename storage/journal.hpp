// SPDX-License-Identifier: Apache-2.0
// What the writing thread knows of the tables: one connection, one statement per kind of row.
#pragma once

#include <filesystem>
#include <string>
#include <unordered_map>

#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// A score on its way to the table.
struct ScoreRow {
  std::string robot;
  core::Score score;
  core::Stamp arrival;
};

/// Rows are durable when the transaction around them was committed. Throws StorageError. One
/// thread.
class Journal {
 public:
  /// The file was prepared (prepare_store).
  explicit Journal(const std::filesystem::path& file);

  [[nodiscard]] Transaction begin() { return {database_, Transaction::Kind::write}; }
  /// To be called when a transaction was not committed.
  void forget_uncommitted() { robot_ids_.clear(); }

  void append(const ScoreRow& row);
  void put(const IncidentChange& change);
  void append(const ConfigText& config);

 private:
  std::int64_t robot_id(const std::string& robot);

  Database database_;
  Statement find_robot_;
  Statement add_robot_;
  Statement add_score_;
  Statement put_incident_;
  Statement add_scan_;
  Statement add_config_;
  std::unordered_map<std::string, std::int64_t> robot_ids_;
};

}  // namespace kidnapwatch::storage
